#include "report/text/time_left.hpp"

#include <catch2/catch.hpp>

using Catch::WithinRel;
using rigcal::report::duration_text;
using rigcal::report::TimeLeft;

TEST_CASE("TimeLeft: the change of the cost tells how far a start is", "[report]") {
  TimeLeft left(1, 1e-10);
  CHECK_FALSE(left.seconds(1.0));
  left.note(1, 0.0);  // no step has been tried yet
  CHECK_FALSE(left.seconds(1.0));
  left.note(1, 1e-2);
  CHECK_THAT(*left.seconds(2.0), WithinRel(8.0, 1e-12));
  left.note(1, 1e-5);
  CHECK_THAT(*left.seconds(3.0), WithinRel(3.0, 1e-12));
  left.note(1, 1e-1);  // a step backwards is ignored
  CHECK_THAT(*left.seconds(3.0), WithinRel(3.0, 1e-12));
  left.note(1, 1e-12);
  CHECK(*left.seconds(19.0) < 1.01);
}

TEST_CASE("TimeLeft: starts that are done count whole, resumed ones not at all", "[report]") {
  TimeLeft left(10, 1e-10);
  left.note(5, 1e-2);  // starts 5 to 10 must be made
  left.note(8, 0.0);
  CHECK_THAT(*left.seconds(30.0), WithinRel(30.0, 1e-12));
  left.note(6, 1e-3);  // the best start is refined at the end
  CHECK(*left.seconds(60.0) <= 60.0);
  left.note(10, 1e-9);
  CHECK_THAT(*left.seconds(59.0), WithinRel(1.0, 1e-12));
}

TEST_CASE("TimeLeft: a start beyond those planned counts too", "[report]") {
  TimeLeft left(1, 1e-8);
  left.note(1, 1e-4);
  left.note(2, 1e-4);  // one and a half of two starts are done
  CHECK_THAT(left.seconds(30.0).value(), WithinRel(10.0, 1e-9));
}

TEST_CASE("duration_text: three digits at most", "[report]") {
  CHECK(duration_text(0.2) == "1 s");
  CHECK(duration_text(98.0) == "98 s");
  CHECK(duration_text(210.0) == "3.5 min");
  CHECK(duration_text(4.0 * 3600.0) == "4 h");
}
