#include "calib/score/worst.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace rigcal::calib {
namespace {

using datasets::Use;

LimitCheck check_of(std::optional<double> value, std::optional<double> tolerance_used) {
  LimitCheck check;
  check.value = value;
  check.tolerance_used = tolerance_used;
  return check;
}

Badness bad(std::optional<Verdict> verdict, double used, double rho2) {
  Badness result{false, verdict};
  result.add(check_of(0.9, used));
  result.add_rho2(rho2);
  return result;
}

}  // namespace

TEST_CASE("worst: what has no score, then by verdict, used tolerance and rho2", "[calib]") {
  Badness unusable{true, Verdict::fail};
  Badness without_value{false, Verdict::fail};
  without_value.add(check_of(std::nullopt, std::nullopt));
  without_value.add(check_of(0.9, 0.1));
  // From the worst to the best, each row differs from the next in what counts first.
  const std::vector<Badness> order{unusable,
                                   without_value,
                                   bad(Verdict::fail, 3.0, 0.9),
                                   bad(Verdict::fail, 2.0, 0.1),
                                   bad(Verdict::warn, 0.9, 0.1),
                                   bad(Verdict::pass, 0.4, std::nan("")),
                                   bad(Verdict::pass, 0.4, 0.2),
                                   bad(Verdict::pass, 0.4, 0.3),
                                   bad(Verdict::pass, 0.3, 0.1),
                                   bad(std::nullopt, 0.0, 0.1)};
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    CAPTURE(i);
    CHECK(order[i + 1] < order[i]);
    CHECK_FALSE(order[i] < order[i + 1]);
  }
}

TEST_CASE("worst: the worst limit and the lowest rho2 of a condition count", "[calib]") {
  ConditionScore score;
  score.verdict = Verdict::warn;
  score.limit_checks = {check_of(0.9, 0.8), check_of(0.9, 0.2)};
  for (const double rho2 : {0.95, 0.7, 0.99}) {
    ChannelScore channel;
    channel.metrics.rho2 = rho2;
    score.channels.push_back(channel);
  }
  const Badness found = badness(score);
  CHECK_FALSE(found.unusable);
  CHECK(found.verdict == Verdict::warn);
  CHECK(found.tolerance_used == 0.8);
  CHECK(found.disagreement == Approx(0.3));
  score.not_scored = "no sample counts";
  CHECK(badness(score).unusable);
}

TEST_CASE("worst: shown first are failures, then validation records", "[calib]") {
  const Badness fails = bad(Verdict::fail, 1.1, 0.9);
  const Badness fails_more = bad(Verdict::fail, 1.2, 0.9);
  const Badness passes = bad(Verdict::pass, 0.2, 0.9);
  const Badness warned = bad(Verdict::warn, 0.9, 0.9);
  CHECK(shown_before(Use::fit, fails, Use::validate, warned));
  CHECK(shown_before(Use::validate, fails, Use::fit, fails_more));
  CHECK(shown_before(Use::validate, passes, Use::fit, warned));
  CHECK(shown_before(Use::validate, warned, Use::validate, passes));
  CHECK(shown_before(Use::fit, Badness{true, std::nullopt}, Use::validate, warned));
  CHECK_FALSE(shown_before(Use::fit, passes, Use::fit, passes));
}

}  // namespace rigcal::calib
