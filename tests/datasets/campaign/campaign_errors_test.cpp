#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::kExample;
using rigcal::test::line_of;
using rigcal::test::load_text;
using rigcal::test::replaced;
using rigcal::test::TemporaryFolder;

namespace {

struct Failure {
  long line = -1;
  std::string message;
};

Failure failure_of(const std::string& text) {
  try {
    load_text(text);
  } catch (const InputError& error) {
    CHECK(error.code() == ExitCode::bad_input);
    return {error.where().line, error.what()};
  }
  return {-1, "(loaded)"};
}

/// A change that makes the example campaign invalid.
struct Mistake {
  std::string from;
  std::string to;
  std::string at;  ///< text in the line that the message refers to
  std::vector<std::string> says;
};

void check(const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    const std::string text = replaced(kExample, mistake.from, mistake.to);
    const Failure failure = failure_of(text);
    CAPTURE(mistake.to, failure.message);
    CHECK(failure.line == line_of(text, mistake.at));
    for (const std::string& words : mistake.says) {
      CHECK_THAT(failure.message, Catch::Contains(words));
    }
  }
}

const std::string kMass =
    R"(mass = { start = "60 kg", lower = "10 kg", upper = "500 kg", fit = true })";
const std::string kSine = "waveform = \"sine\"\nfrequency = \"0.1 Hz\"\namplitude = \"50.8 mm\"\n";
const std::string kSineFiles = "repeats = [\"records/sine_0.1Hz_33_*.csv\"]\n";

}  // namespace

TEST_CASE("load_campaign: schema and syntax", "[datasets]") {
  CHECK_THAT(failure_of("").message, Catch::Contains("'schema' is missing"));
  check({
      {"schema = \"rigcal.campaign/1\"\n",
       "",
       "name",
       {"'schema' is missing", "rigcal.campaign/1"}},
      {"rigcal.campaign/1", "rigcal.campaign/9", "schema", {"rigcal.campaign/9", "campaign/1\""}},
      {"kp = \"78.74 V/m\"", "kp = = 1", "kp = =", {"not valid TOML"}},
      {"align = \"correlate\"", "align = \"none\"\nx = 1\nalign = 2", "align = 2", {"align"}},
  });
}

TEST_CASE("load_campaign: unknown names tell the nearest", "[datasets]") {
  check({
      {"name = ", "nmae = ", "nmae", {"did you mean 'name'"}},
      {"[averaging]", "[averagin]", "[averagin]", {"did you mean 'averaging'"}},
      {"supply_pressure = \"6.2 MPa\"",
       "suply_pressure = \"6.2 MPa\"",
       "suply",
       {"'supply_pressure'"}},
      {"type = \"pid\"", "typ = \"pid\"", "rig.controller", {"'rig.controller.type' is missing"}},
      {"kp = ", "kq = ", "kq = ", {"unknown parameter 'kq'", "did you mean 'kp'"}},
      {"\"load_pressure\"", "\"two_chambers\"", "two_chambers", {"rig.model", "'two_chamber'"}},
      {"\"pid\"", "\"pidd\"", "pidd", {"rig.controller.type", "did you mean 'pid'"}},
      {"initial = ", "initials = ", "initials", {"did you mean 'initial'"}},
      {"reference = {",
       "referense = {",
       "referense",
       {"unknown channel", "did you mean 'reference'"}},
      {"column = \"x_mm\"",
       "colum = \"x_mm\"",
       "colum =",
       {"recording.channels.position", "did you mean 'column'"}},
      {"warn_rho2 = ", "warn_rho = ", "warn_rho =", {"unknown metric", "did you mean 'warn_rho2'"}},
      {"use = \"fit\"", "use = \"fitt\"", "fitt", {"did you mean 'fit'"}},
      {"leak_level = \"none\"",
       "leek_level = \"none\"",
       "leek",
       {"condition \"steps\"", "did you mean 'leak_level'"}},
      {"lower = \"10 kg\"", "lowr = \"10 kg\"", "lowr", {"did you mean 'lower'"}},
      {"scope = \"leak_level\"",
       "scope = \"leaklevel\"",
       "leaklevel",
       {"scope", "did you mean 'leak_level'"}},
      {"columns = { position",
       "columns = { positon",
       "positon",
       {"unknown channel", "did you mean 'position'"}},
      {"parameters = { }", "parameters = { masss = \"1 kg\" }", "masss", {"did you mean 'mass'"}},
      {"parameters = { }", "classes = 3", "classes", {"unknown key 'classes'"}},
      {"[averaging]", "[fit]\nlos = \"huber\"\n[averaging]", "los =", {"did you mean 'loss'"}},
      {"[averaging]",
       "[synthetic]\nnoise = { postion = \"1 mm\" }\n[averaging]",
       "postion",
       {"did you mean 'position'"}},
  });
}

TEST_CASE("load_campaign: types, units and limits of parameters", "[datasets]") {
  const auto mass = [](const std::string& entry, std::vector<std::string> says) {
    return Mistake{kMass, "mass = " + entry, "mass = ", std::move(says)};
  };
  std::vector<Mistake> mistakes{
      mass("60", {"rig.parameters.mass", "the number 60", "\"60 kg\""}),
      mass("true", {"found true"}),
      mass("\"60 mm\"", {"a length", "a mass"}),
      mass("\"60\"", {"unit"}),
      mass("\"nan kg\"", {"not finite"}),
      mass("\"-5 kg\"", {"-5 kg is not plausible", "expected 0.001 kg"}),
      mass("{ lower = \"1 kg\" }", {"rig.parameters.mass.start", "missing"}),
      mass("{ start = \"60 kg\", lower = \"70 kg\", upper = \"80 kg\" }",
           {"mass.start", "outside"}),
      mass("{ start = \"90 kg\", lower = \"70 kg\", upper = \"80 kg\" }",
           {"mass.start", "outside"}),
      mass("{ start = \"60 kg\", lower = \"80 kg\", upper = \"80 kg\" }",
           {"mass.lower", "not below"}),
      mass("{ start = \"60 kg\", upper = \"1e9 kg\" }", {"mass.upper", "is not plausible"}),
      mass("{ start = \"60 kg\", fit = 1 }", {"mass.fit", "true or false"}),
      mass("{ start = \"60 kg\", prior = \"60 kg\" }", {"mass.prior", "prior_sd"}),
      mass("{ start = \"60 kg\", prior_sd = \"6 kg\" }", {"mass.prior_sd", "no prior"}),
      mass("{ start = \"60 kg\", prior = \"60 kg\", prior_sd = \"0 kg\" }",
           {"mass.prior_sd", "above zero"}),
      mass("{ start = \"60 kg\", between_repeats = \"0 kg\" }",
           {"mass.between_repeats", "above zero"}),
      mass("{ start = \"60 kg\", between_repeats = \"1 Hz\" }", {"mass.between_repeats"}),
      mass("{ start = \"60 kg\", between_repeats = \"1 kg\", fit = true }",
           {"mass.fit", "is combined with between_repeats"}),
      mass("{ start = \"60 kg\", between_repeats = \"1 kg\", scope = \"rig\" }",
           {"mass.scope", "is combined with between_repeats"}),
  };
  check(mistakes);
  check({
      {"discharge_coefficient = 0.6",
       "discharge_coefficient = \"0.6\"",
       "discharge",
       {"plain number"}},
      {"discharge_coefficient = 0.6",
       "discharge_coefficient = inf",
       "discharge",
       {"finite number"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nleakage_smoothing = { start = \"100 Pa\", fit = true }",
       "leakage_smoothing",
       {"leakage_smoothing.fit", "cannot be fitted"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nkp = \"1 V/m\"",
       "kp = \"1",
       {"rig.parameters.kp", "[rig.controller]"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\ninitial_position = \"1 mm\"",
       "initial_position",
       {"initial = \"fit\""}},
      {"kp = \"78.74 V/m\"",
       "kp = \"78.74 V/m\"\nmass = \"1 kg\"",
       "mass = \"1",
       {"rig.controller.mass", "[rig.parameters]"}},
      {"kp = \"78.74 V/m\"",
       "kp = { start = \"78.74 V/m\", scope = \"leak_level\" }",
       "kp =",
       {"rig.controller.kp.scope"}},
      {"kp = \"78.74 V/m\"\n", "", "[[condition]]", {"no kp"}},
      {"kp = \"78.74 V/m\"", "kp = \"78.74 V/m\"\nkd = \"1 V s/m\"", "kd =", {"derivative_filter"}},
      {"kp = \"78.74 V/m\"",
       "kp = \"78.74 V/m\"\nderivative_filter = \"500 1/s\"",
       "derivative_filter",
       {"rad/s"}},
      {"type = \"pid\"", "type = \"none\"", "kp = \"78", {"type is \"none\""}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nvalve_time_constant = \"1 ms\"\nvalve_frequency = \"80 "
       "Hz\"\nvalve_damping_ratio = 0.7",
       "valve_time_constant",
       {"valve_frequency"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nvalve_time_constant = \"-1 us\"",
       "valve_time_constant",
       {"valve_time_constant", "first-order lag", "expected 0 s to 10 s"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nposition_lag = { start = \"-1 ms\", fit = true }",
       "position_lag",
       {"position_lag", "expected 0 s to 10 s"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nvalve_frequency = \"80 Hz\"",
       "valve_frequency",
       {"valve_damping_ratio"}},
      {"stiffness = \"0 N/m\"",
       "stiffness = \"0 N/m\"\nvalve_damping_ratio = 0.7",
       "valve_damping_ratio",
       {"valve_frequency"}},
      {"stiffness = \"0 N/m\"\npiston_area = \"633 mm2\"\n",
       "",
       "[[condition]]",
       {"no value for stiffness, piston_area"}},
      {"parameters = { leakage_coefficient = 0.35 }",
       "parameters = { leakage_coefficient = { start = 1 } }",
       "{ start = 1 }",
       {"leak_level.\"33.33 %\".parameters.leakage_coefficient", "known value"}},
  });
}

TEST_CASE("load_campaign: conditions", "[datasets]") {
  const auto id = [](const std::string& text, std::vector<std::string> says) {
    return Mistake{"id = \"steps\"", "id = " + text, "id = " + text, std::move(says)};
  };
  check({
      id("\"a b\"", {"condition[2].id", "letters, digits"}),
      id("\"..\"", {"letters, digits"}),
      id("\".\"", {"letters, digits"}),
      id("\"../x\"", {"letters, digits"}),
      id("\"\"", {"id"}),
      id("\"<script>\"", {"letters, digits"}),
      id("\"sine_0.1HZ_open_33\"", {"only in case"}),
      {"id = \"steps\"\n",
       "",
       "[[condition]]\nwaveform = \"recorded\"",
       {"condition[2].id", "missing"}},
      {"waveform = \"sine\"\n", "", "[[condition]]", {".waveform' is missing"}},
      {kSine,
       "waveform = \"sine\"\namplitude = \"1 mm\"\n",
       "[[condition]]",
       {".frequency' is missing"}},
      {kSine,
       "waveform = \"square\"\nfrequency = \"1 Hz\"\n",
       "[[condition]]",
       {".amplitude' is missing"}},
      {"\"sine\"\n", "\"chirp\"\n", "[[condition]]", {".end_frequency' is missing"}},
      {"waveform = \"sine\"",
       "waveform = \"sine\"\nend_frequency = \"5 Hz\"",
       "end_frequency",
       {"expected only for a chirp"}},
      {"frequency = \"0.1 Hz\"",
       "frequency = \"0.1 rad/s\"\nsweep = \"linear\"",
       "sweep =",
       {"expected only for a chirp"}},
      {"frequency = \"0.1 Hz\"", "frequency = \"0.1 1/s\"", "0.1 1/s", {".frequency", "Hz"}},
      {"frequency = \"0.1 Hz\"", "frequency = \"0 Hz\"", "\"0 Hz\"", {"above zero"}},
      {"amplitude = \"50.8 mm\"",
       "amplitude = \"5 V\"",
       "\"5 V\"",
       {".amplitude", "position reference, in m"}},
      {"leak_level = \"33.33 %\"\n", "", "[[condition]]", {"leakage_coefficient", "leak_level"}},
      {"leak_level = \"33.33 %\"\n", "leak_level = \"\"\n", "leak_level = \"\"", {"leak_level"}},
      {kSineFiles, "", "[[condition]]", {"neither a record nor both duration and sample_rate"}},
      {kSineFiles, "duration = \"1 s\"\n", "[[condition]]", {"neither a record nor"}},
      {kSineFiles, "duration = \"-1 s\"\n", "\"-1 s\"", {"above zero"}},
      {kSineFiles, "duration = \"1e6 s\"\nsample_rate = \"1 MHz\"\n", "1e6 s", {"samples"}},
      {kSineFiles, "repeats = []\n", "repeats = []", {"at least one file"}},
      {kSineFiles, "repeats = \"a.csv\"\n", "repeats = \"a.csv\"", {"list of files"}},
      {kSineFiles, "repeats = [3]\n", "repeats = [3]", {".repeats[1]"}},
      {kSineFiles,
       kSineFiles + "averaged = \"a.csv\"\n",
       "averaged",
       {"cannot be combined with repeats"}},
      {kSineFiles, kSineFiles + "repeats_averaged = 5\n", "repeats_averaged", {"averaged"}},
      {kSineFiles,
       kSineFiles + "planned_repeats = 5\n",
       "planned_repeats",
       {"combined with a record"}},
      {kSineFiles,
       "averaged = \"a.csv\"\nrepeats_averaged = 0\n",
       "repeats_averaged",
       {"whole number"}},
      {"n = \"01..10\", columns = { position = \"x_mm_A",
       "n = \"10..01\", columns = { position = \"x_mm_A",
       "10..01",
       {".n", "01..10"}},
      {"n = \"01..10\", columns = { position = \"x_mm_A",
       "columns = { position = \"x_mm_A",
       "x_mm_A{n}",
       {"{n}"}},
      {"columns = { position = \"x_mm_A{n}\", pressure_a = \"pA_bar_{n}\" }",
       "columns = { position = \"x\" }",
       "= \"x\"",
       {".n", "{n}"}},
      {"columns = { position = \"x_mm_A{n}\"",
       "columns = { force = \"x_mm_A{n}\"",
       "force",
       {"columns.force", "no unit"}},
      {"window = [\"0.5 s\", \"12 s\"]",
       "window = [\"12 s\", \"0.5 s\"]",
       "window",
       {"not before"}},
      {"window = [\"0.5 s\", \"12 s\"]",
       "window = [[\"1 s\", \"3 s\"], [\"2 s\", \"4 s\"]]",
       "window",
       {"window[2]", "in increasing order"}},
      {"window = [\"0.5 s\", \"12 s\"]", "window = [\"0.5 s\"]", "window", {"start and end"}},
      {"window = [\"0.5 s\", \"12 s\"]", "window = [0.5, 12]", "window", {"\"0.5 s\""}},
      {"window = [\"0.5 s\", \"12 s\"]", "windows = \"all\"", "windows", {"known: moving"}},
      {"temperature = \"38 degC\"",
       "windows = \"moving\"",
       "windows",
       {"cannot be combined with window"}},
      {"date = 2026-03-01", "date = \"yesterday\"", "date =", {".date", "2026-03-01"}},
      {"temperature = \"38 degC\"", "temperature = 38", "temperature", {"number unit"}},
      {"column = \"ref_mm\", ", "", "[[condition]]\nid = \"steps\"", {"recorded", "reference"}},
      {"unit = \"mm\" }\npos",
       "unit = \"mm\", role = \"ignore\" }\npos",
       "[[condition]]\nid = \"steps\"",
       {"role \"input\""}},
      {"time = { column = \"t_s\", unit = \"s\" }\n", "", "[[condition]]", {"time"}},
      {"sd = \"0.05 mm\" }", "role = \"ignore\" }", "[[condition]]", {"no output channel"}},
  });
  std::string no_conditions = kExample.substr(0, kExample.find("[[condition]]"));
  CHECK_THAT(failure_of(no_conditions).message, Catch::Contains("at least one [[condition]]"));
}

TEST_CASE("load_campaign: recorded needs a record", "[datasets]") {
  const std::size_t at = kExample.find("repeats = [ {");
  const std::string text = kExample.substr(0, at) + "duration = \"1 s\"\nsample_rate = \"9 Hz\"\n";
  const Failure failure = failure_of(text);
  CHECK_THAT(failure.message, Catch::Contains("\"recorded\" needs a record"));
  CHECK(failure.line == line_of(text, "[[condition]]\nid = \"steps\""));
}

TEST_CASE("load_campaign: without a controller the command drives", "[datasets]") {
  std::string text = replaced(kExample, "type = \"pid\"\nkp = \"78.74 V/m\"", "type = \"none\"");
  CHECK_THAT(failure_of(text).message, Catch::Contains("valve command, in V"));
  text = replaced(text, "\"50.8 mm\"", "\"5 V\"");
  CHECK_THAT(failure_of(text).message, Catch::Contains("channel command"));
  text = replaced(text, "[averaging]", "command = { column = \"u\", unit = \"V\" }\n[averaging]");
  CHECK(load_text(text).channels.at(Channel::command).role == ChannelRole::input);
  text = replaced(text, "parameters = { }", "controller = { kp = \"5 V/m\" }");
  CHECK_THAT(failure_of(text).message, Catch::Contains("no controller"));
}

TEST_CASE("load_campaign: recording, acceptance and settings", "[datasets]") {
  check({
      {"unit = \"mm\", sd",
       "unit = \"bar\", sd",
       "position = {",
       {"channels.position.unit", "a length"}},
      {"unit = \"mm\", sd", "sd", "position = {", {"channels.position.unit", "missing"}},
      {"sd = \"0.05 mm\"", "sd = \"0 mm\"", "position = {", {"position.sd", "above zero"}},
      {"sd = \"0.05 mm\"", "gain = \"2\"", "position = {", {"position.gain", "plain number"}},
      {"sd = \"0.05 mm\"", "gain_sd = 1.5", "position = {", {"position.gain_sd", "below 1"}},
      {"sd = \"0.05 mm\"", "offset_sd = \"-1 mm\"", "position = {", {"position.offset_sd"}},
      {"sd = \"0.05 mm\"", "gain = 0", "position = {", {"position.gain", "zero"}},
      {"rho2 = 0.99\n",
       "rho2 = 0.99\nnot_judged = [\"pressure_c\"]\n",
       "not_judged",
       {"acceptance.not_judged[1]", "pressure_a"}},
      {"rho2 = 0.99\n",
       "rho2 = 0.99\nnot_judged = [\"position\"]\n",
       "not_judged",
       {"acceptance.not_judged[1]", "limit of rho2"}},
      {"parameters = { }",
       "acceptance = { not_judged = [\"pressure_a\"], pressure_a = { rho2 = 0.9 } }",
       "acceptance = {",
       {"not_judged[1]", "pressure_a"}},
      {"sd = \"0.05 mm\"",
       "role = \"input\"",
       "position = {",
       {"position.role", "cannot be an input"}},
      {"column = \"x_mm\"",
       "minus = \"y_mm\"",
       "position = {",
       {"position.minus", "no column to subtract"}},
      {"column = \"ref_mm\"",
       "column = \"ref_mm\", role = \"output\"",
       "reference = {",
       {"does not compute"}},
      {"separator = \",\"", "separator = \"|\"", "separator", {"recording.separator"}},
      {"initial = \"rest\"",
       "initial = \"rest\"\nbefore = \"later\"",
       "before = ",
       {"recording.before", "hold, rest, steady"}},
      {"initial = \"rest\"",
       "initial = \"record\"\nbefore = \"steady\"",
       "before = ",
       {"recording.before", "without `initial`"}},
      {"initial = \"rest\"",
       "initial = \"rest\"\nholes = \"bridge\"",
       "[recording]",
       {"recording.longest_hole", "longest hole"}},
      {"initial = \"rest\"",
       "initial = \"rest\"\nlongest_hole = \"1 s\"",
       "longest_hole = ",
       {"recording.longest_hole", "holes = \"bridge\""}},
      {"initial = \"rest\"",
       "initial = \"rest\"\nholes = \"bridge\"\nlongest_hole = \"1 m\"",
       "longest_hole = ",
       {"recording.longest_hole", "'m' is the unit of a length"}},
      {"initial = \"rest\"",
       "initial = \"rest\"\ninitial_window = \"1 s\"",
       "initial_window",
       {"record"}},
      {"rho2 = 0.99\n", "rho2 = 1.5\n", "rho2 = 1.5", {"acceptance.rho2"}},
      {"warn_rho2 = 0.995", "warn_rho2 = 0.9", "warn_rho2", {"less strict"}},
      {"rho2 = 0.99\n",
       "decision = \"lenient\"\n",
       "lenient",
       {"acceptance.decision", "guard_band"}},
      {"ccc = 0.99", "rmse = 0.99", "rmse", {"acceptance.rmse", "\"0.99 m\""}},
      {"parameters = { }",
       "acceptance = { rho3 = 0.9 }",
       "acceptance = {",
       {"condition \"", "acceptance", "rho2"}},
      {"[averaging]",
       "[acceptance.force]\nrho2 = 0.9\n[averaging]",
       "[acceptance.force]",
       {"not an output channel"}},
      {"[averaging]", "[fit]\nstarts = 0\n[averaging]", "starts", {"fit.starts", "whole number"}},
      {"[averaging]", "[fit]\nmax_time = 60\n[averaging]", "max_time", {"\"60 s\""}},
      {"[averaging]",
       "[fit]\nshooting_interval = \"0.2 s\"\n[averaging]",
       "shooting_interval",
       {"fit.shooting_interval", "removed", "starts"}},
      {"[averaging]", "[fit]\nposterior = 99\n[averaging]", "posterior", {"100"}},
      {"[averaging]", "[fit]\nposterior = true\n[averaging]", "posterior", {"whole number"}},
      {"[averaging]", "[fit]\noutputs = [\"force\"]\n[averaging]", "outputs", {"fit.outputs[1]"}},
      {"[averaging]",
       "[simulation]\ntolerance = 2\n[averaging]",
       "tolerance",
       {"simulation.tolerance"}},
      {"[averaging]",
       "[synthetic]\nvariation = { mass = 2 }\n[averaging]",
       "variation",
       {"variation.mass"}},
      {"[averaging]", "[synthetic]\nar1_coefficient = 1\n[averaging]", "ar1_", {"below 1"}},
      {"[averaging]",
       "[synthetic]\ntrigger_jitter = \"-1 ms\"\n[averaging]",
       "trigger_",
       {"not negative"}},
  });
}

TEST_CASE("load_campaign: the gain of a sensor is not uncertain twice", "[datasets]") {
  const std::string stated = replaced(kExample, "sd = \"0.05 mm\"", "gain_sd = 0.005");
  for (const char* gain : {"{ start = 1, lower = 0.9, upper = 1.1, fit = true }",
                           "{ start = 1, prior = 1, prior_sd = 0.01 }"}) {
    const std::string text = replaced(stated, kMass, kMass + "\nposition_gain = " + gain);
    const Failure failure = failure_of(text);
    CAPTURE(failure.message);
    CHECK(failure.line == line_of(text, "gain_sd"));
    CHECK_THAT(failure.message,
               Catch::Contains("channels.position.gain_sd") && Catch::Contains("position_gain") &&
                   Catch::Contains(":" + std::to_string(line_of(text, "position_gain")) + ":"));
  }
  Campaign campaign = load_text(replaced(stated, kMass, kMass + "\nposition_gain = 1.0"));
  set_free(campaign, {"position_gain"});
  CHECK_THROWS_WITH(check_values(campaign), Catch::Contains("position.gain_sd"));
}

TEST_CASE("load_campaign: the column is told as well", "[datasets]") {
  const TemporaryFolder folder;
  const auto file = folder.write("c.toml", replaced(kExample, "lower = \"10 kg\"", "lower = 10"));
  const long line = line_of(kExample, "mass = ");
  // In `mass = { start = "60 kg", lower = 10`, the value is in column 35.
  CHECK_THROWS_WITH(load_campaign(file),
                    Catch::StartsWith(file.string() + ":" + std::to_string(line) +
                                      ":35: key "
                                      "'rig.parameters.mass.lower': "));
}

TEST_CASE("load_campaign: survives files that are no campaigns", "[datasets]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content) {
    CHECK_THROWS_AS(load_campaign(folder.write("c.toml", content)), InputError);
  };
  refused("");
  refused(
      std::string("\x7f"
                  "ELF\0\0\xff\xfe\0",
                  9));
  refused(std::string(1000, '\0'));
  refused("a = " + std::string(1'000'000, '['));
  refused("a = " + std::string(1'000'000, '{'));
  std::string nested = "a";
  for (int i = 0; i < 1'000'000; ++i) nested += ".a";
  refused(nested + " = 1");
  refused("[" + nested + "]");
  refused("x = \"\"\" \\\" ' \n\"\"\"\n" + nested + " = 1");
  refused("x = { b = '''\n''', " + nested + " = 1 }");
  refused("schema = \"rigcal.campaign/1\"\n" + std::string(1'000'000, 'k') + " = 1");
  refused("schema = \"" + std::string(1'000'000, 'k') + "\"");
  CHECK_THROWS_AS(load_campaign(folder.path()), InputError);
  CHECK_THROWS_AS(load_campaign(folder.path() / "none.toml"), InputError);
  CHECK_THROWS_AS(load_campaign("/dev/zero"), InputError);
}

TEST_CASE("load_campaign: refuses files that are too large unread", "[datasets]") {
  const TemporaryFolder folder;
  const auto file = folder.write("c.toml", "#");
  std::filesystem::resize_file(file, 100 << 20);
  CHECK_THROWS_WITH(load_campaign(file), Catch::Contains("at most 16 MB"));
}
