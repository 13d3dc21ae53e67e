#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"
#include "tests/report/stored_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
using nlohmann::json;

namespace {

/// Returns the numbers in one column of a CSV file.
std::vector<double> column(const std::string& csv, const std::string& title) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto fields = [](const std::string& text) {
    std::vector<std::string> list;
    std::istringstream stream(text);
    for (std::string field; std::getline(stream, field, ',');) list.push_back(field);
    return list;
  };
  const auto titles = fields(line);
  const auto place = std::find(titles.begin(), titles.end(), title) - titles.begin();
  std::vector<double> values;
  while (std::getline(lines, line)) values.push_back(std::stod(fields(line).at(place)));
  return values;
}

/// Checks the response to bad input: exit code 2, one line on stderr that names place and problem,
/// and no files.
void check_bad_input(const CommandFolder& folder, const CommandFolder::Arguments& arguments,
                     const std::vector<std::string>& parts) {
  const auto before = folder.files();
  const Outcome outcome = folder.run(arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, StartsWith("rigcal: "));
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  for (const std::string& part : parts) CHECK_THAT(outcome.err, Contains(part));
  CHECK(folder.files() == before);
  CHECK_FALSE(folder.has("rigcal-out"));
}

void check_finite(const json& value) {
  if (value.is_number_float()) CHECK(std::isfinite(value.get<double>()));
  if (!value.is_structured()) return;
  for (const json& each : value) check_finite(each);
}

bool says_something(const json& value) {
  return value.is_string() && !value.get<std::string>().empty();
}

/// Checks that the page drawn from the objects of a run is the one drawn from its files.
void check_page_of_files(const CommandFolder& folder, const std::string& out) {
  const std::string page = folder.read(out + "/report.html");
  CHECK(folder.run({"report", out}).exit_code == 0);
  CHECK(folder.read(out + "/report.html") == page);
}

/// Checks that every number in a fit.json or validation.json is finite, and that a reason is given
/// for every missing one.
void check_complete(const std::string& text) {
  const json result = json::parse(text);
  check_finite(result);
  CHECK(says_something(result["message"]));
  const bool estimated = result["status"] != "failed" && !result["starts"].empty();
  CHECK(result["cost"].is_number() == estimated);
  for (const json& parameter : result["parameters"]) {
    CAPTURE(parameter.dump());
    CHECK((parameter["value"].is_number() || says_something(parameter["reason"])));
    if (!parameter["fitted"].get<bool>()) continue;
    for (const char* key : {"start", "lower", "upper"}) CHECK(parameter[key].is_number());
    for (const char* key : {"standard_error", "robust_standard_error", "ci95"})
      CHECK((!parameter[key].is_null() || says_something(parameter["reason"])));
  }
  for (const json& condition : result["conditions"]) {
    for (const json& channel : condition["metrics"]) {
      CAPTURE(condition["id"].dump(), channel.dump());
      const bool explained =
          says_something(channel["problem"]) || says_something(condition["failure"]);
      for (const char* key : {"rho2", "r", "ccc", "absolute_error_percent", "rmse"})
        CHECK((channel[key].is_number() || explained));
    }
  }
  for (const json& start : result["starts"]) {
    CHECK((start["initial_cost"].is_number() || says_something(start["message"])));
    CHECK((start["final_cost"].is_number() || says_something(start["message"])));
  }
}

struct BadCampaign {
  const char* name;
  Edits edits;
  std::vector<std::string> message;
};

// The column is that of the value, or that of the key if it has no value.
const std::vector<BadCampaign> kBadCampaigns{
    {"not TOML", {{"name = \"small rig\"", "name = small rig"}}, {"campaign.toml:2:"}},
    {"no schema", {{"schema = \"rigcal.campaign/1\"\n", ""}}, {"campaign.toml", "schema"}},
    {"another schema", {{"campaign/1", "campaign/9"}}, {"campaign.toml:1:", "rigcal.campaign/1"}},
    {"unknown key", {{"mass = ", "masss = "}}, {"campaign.toml:7:", "masss", "mass"}},
    {"unknown table", {{"[acceptance]", "[acceptence]"}}, {"campaign.toml:28:", "acceptance"}},
    {"unknown model",
     {{"load_pressure\"", "loud_pressure\""}},
     {"campaign.toml:4:", "load_pressure"}},
    {"number without unit", {{"\"60 kg\"", "60"}}, {"campaign.toml:7:8", "mass"}},
    {"wrong dimension", {{"\"60 kg\"", "\"60 m\""}}, {"campaign.toml:7:8", "mass", "kg"}},
    {"unknown unit", {{"\"60 kg\"", "\"60 stones\""}}, {"campaign.toml:7:8", "stones"}},
    {"decimal comma", {{"\"60 kg\"", "\"60,5 kg\""}}, {"campaign.toml:7:8", "mass"}},
    {"not finite", {{"\"60 kg\"", "\"nan kg\""}}, {"campaign.toml:7:8", "mass"}},
    {"outside the limits", {{"\"60 kg\"", "\"-60 kg\""}}, {"campaign.toml:7:8", "mass", "0.001"}},
    {"unit on a plain number",
     {{"leakage_coefficient = 0.3", "leakage_coefficient = \"0.3 m\""}},
     {"campaign.toml:10:", "leakage_coefficient"}},
    {"missing parameter", {{"density = \"850 kg/m3\"\n", ""}}, {"campaign.toml", "density"}},
    {"rad/s for Hz, unit of another kind",
     {{"\"2 Hz\"", "\"2 1/s\""}},
     {"campaign.toml:34:", "frequency"}},
    {"start outside its bounds",
     {{"start = \"2000 N s/m\"", "start = \"1 N s/m\""}},
     {"campaign.toml:8:", "damping", "bounds"}},
    {"bounds the wrong way",
     {{"lower = \"10 N s/m\"", "lower = \"1e6 N s/m\""}},
     {"campaign.toml:8:", "lower"}},
    {"unknown scope",
     {{"upper = \"1e5 N s/m\"", "upper = \"1e5 N s/m\", scope = \"day\""}},
     {"campaign.toml:8:", "scope", "leak_level"}},
    {"prior without sd",
     {{"upper = \"1e5 N s/m\"", "upper = \"1e5 N s/m\", prior = \"900 N s/m\""}},
     {"campaign.toml:8:", "prior_sd"}},
    {"controller unknown", {{"\"pid\"", "\"pidd\""}}, {"campaign.toml:20:", "pid"}},
    {"gain without controller", {{"\"pid\"", "\"none\""}}, {"campaign.toml:21:", "kp"}},
    {"unknown channel", {{"position = {", "postion = {"}}, {"campaign.toml:26:", "position"}},
    {"channel without unit",
     {{"column = \"x_mm\", unit = \"mm\"", "column = \"x_mm\""}},
     {"campaign.toml:26:", "unit"}},
    {"channel in a wrong unit",
     {{"column = \"x_mm\", unit = \"mm\"", "column = \"x_mm\", unit = \"bar\""}},
     {"campaign.toml:26:", "bar"}},
    {"unknown metric", {{"rho2 = 0.9", "rho3 = 0.9"}}, {"campaign.toml:29:", "rho2"}},
    {"unknown channel that is not judged",
     {{"not_judged = [\"load_pressure\"]", "not_judged = [\"load\"]"}},
     {"campaign.toml:30:15", "acceptance.not_judged[1]", "load_pressure"}},
    {"a limit for what is not judged",
     {{"not_judged = [\"load_pressure\"]", "not_judged = [\"position\"]"}},
     {"campaign.toml:30:15", "position", "rho2"}},
    {"metric out of range", {{"rho2 = 0.9", "rho2 = 1.9"}}, {"campaign.toml:29:", "rho2"}},
    {"unknown waveform",
     {{"waveform = \"sine\"", "waveform = \"sinus\""}},
     {"campaign.toml:33:", "sine"}},
    {"unknown use", {{"use = \"fit\"", "use = \"fitt\""}}, {"campaign.toml:37:", "validate"}},
    {"sine without frequency", {{"frequency = \"2 Hz\"\n", ""}}, {"campaign.toml:", "frequency"}},
    {"two conditions of one id",
     {{"id = \"square\"", "id = \"sine\""}},
     {"campaign.toml:40:", "sine"}},
    {"id that is no file name",
     {{"id = \"sine\"", "id = \"../sine\""}},
     {"campaign.toml:32:", "id"}},
    {"repeats that match nothing",
     {{"records/sine_*.csv", "records/sinus_*.csv"}},
     {"campaign.toml:", "sinus_*.csv", "records"}},
    {"column that the file lacks",
     {{"column = \"x_mm\"", "column = \"y_mm\""}},
     {"sine_1.csv:1", "y_mm", "x_mm"}},
    {"window the wrong way",
     {{"use = \"fit\"", "use = \"fit\"\nwindow = [\"1 s\", \"0.5 s\"]"}},
     {"campaign.toml:38:", "window"}},
};

struct BadRecord {
  const char* name;
  std::string content;
  std::vector<std::string> message;
};

const std::vector<BadRecord> kBadRecords{
    {"empty file", "", {"sine_1.csv"}},
    {"header alone", "t_s,ref_mm,x_mm,pl_bar\n", {"sine_1.csv"}},
    {"no number", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,oops,0\n", {"sine_1.csv:3:7:", "oops"}},
    {"empty field", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,,0\n", {"sine_1.csv:3:7:"}},
    {"not finite", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,nan,0\n", {"sine_1.csv:3:7:", "nan"}},
    {"too few columns", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,0\n", {"sine_1.csv:3"}},
    {"too many columns", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,0,0,0\n", {"sine_1.csv:3"}},
    {"time that stands still",
     "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n0.1,0,0,0\n0.1,0,0,0\n",
     {"sine_1.csv:4", "t_s"}},
    {"column twice", "t_s,ref_mm,x_mm,x_mm,pl_bar\n0,0,0,0,0\n", {"sine_1.csv:1", "x_mm"}},
    {"binary", std::string("t_s,ref_mm,x_mm,pl_bar\n0,0,0,\0\1\n", 32), {"sine_1.csv"}},
    {"another length", "t_s,ref_mm,x_mm,pl_bar\n0,0,0,0\n7,0,1,0\n14,0,0,1\n", {"sine"}},
};

struct BadCall {
  CommandFolder::Arguments arguments;
  std::vector<std::string> message;
};

const std::vector<BadCall> kBadCalls{
    {{}, {"expected one of check, average", "leak-table, fit-tables", ", params"}},
    {{"fitt", "campaign.toml"}, {"unknown verb 'fitt'", "'fit'"}},
    {{""}, {"unknown verb ''"}},
    {{"--quiet"}, {"--quiet", "a verb first"}},
    {{"fit"}, {"fit: CAMPAIGN is required"}},
    {{"fit", "campaign.toml", "other.toml"}, {"fit: ", "other.toml"}},
    {{"fit", "nowhere.toml"}, {"nowhere.toml"}},
    {{"fit", "records"}, {"records"}},
    {{"fit", "campaign.toml", "--bootstrap", "-1"}, {"--bootstrap"}},
    {{"fit", "campaign.toml", "--posterior", "99"}, {"--posterior", "100 to 100000"}},
    {{"fit", "campaign.toml", "--posterior", "100001"}, {"--posterior"}},
    {{"fit", "campaign.toml", "--posterior", "many"}, {"--posterior"}},
    {{"fit", "campaign.toml", "--max-time", "0"}, {"--max-time"}},
    {{"fit", "campaign.toml", "--threads", "0"}, {"--threads"}},
    {{"fit", "campaign.toml", "--threads=-2"}, {"--threads"}},
    {{"fit", "campaign.toml", "--threads", "many"}, {"--threads"}},
    {{"fit", "campaign.toml", "--starts", "0"}, {"--starts"}},
    {{"fit", "campaign.toml", "--seed", "-1"}, {"--seed"}},
    {{"fit", "campaign.toml", "--seed"}, {"--seed"}},
    {{"fit", "campaign.toml", "--set", "mass"}, {"--set mass", "name=\"value unit\""}},
    {{"fit", "campaign.toml", "--set", "masss=3 kg"}, {"masss", "mass"}},
    {{"fit", "campaign.toml", "--set", "mass=3 m"}, {"--set mass=3 m", "kg"}},
    {{"fit", "campaign.toml", "--set", "mass=-3 kg"}, {"--set mass=-3 kg", "0.001"}},
    {{"fit", "campaign.toml", "--set", "damping=2 N s/m"}, {"--set damping=2 N s/m", "bounds"}},
    {{"fit", "campaign.toml", "--free", "mass,dampling"}, {"dampling", "damping"}},
    {{"fit", "campaign.toml", "--free", "leakage_smoothing"}, {"leakage_smoothing"}},
    {{"fit", "campaign.toml", "--data", "elsewhere"}, {"elsewhere"}},
    {{"simulate", "campaign.toml", "--condition", "sinus"}, {"--condition", "sine"}},
    {{"synthesize", "campaign.toml", "--seed", "1"}, {"campaign.toml", "[synthetic]"}},
    {{"synthesize", "campaign.toml"}, {"--seed"}},
    {{"validate", "campaign.toml", "--fit", "fit.json"}, {"fit.json", "cannot be opened"}},
    {{"params", "campaign.toml"}, {"params: ", "campaign.toml"}},
};

struct BadFit {
  const char* name;
  std::string content;
  std::vector<std::string> message;
};

/// Returns a fit.json with one error.
std::string broken_fit(const std::function<void(json&)>& edit) {
  json fit = json::parse(stored_result().dump());
  edit(fit);
  return fit.dump();
}

const std::vector<BadFit> kBadFits{
    {"not JSON", "{\n  \"schema\": oops\n}\n", {"fit.json:2:", "not JSON"}},
    {"a list", "[]", {"fit.json", "object"}},
    {"another schema", R"({"schema": "rigcal.validation/1"})", {"schema", "rigcal.fit/2"}},
    {"no status", R"({"schema": "rigcal.fit/1"})", {"status", "missing"}},
    {"unknown status",
     R"({"schema": "rigcal.fit/1", "status": "good", "message": ""})",
     {"status", "good", "converged"}},
    {"failed",
     broken_fit([](json& fit) {
       fit["status"] = "failed";
       fit["message"] = "no start";
     }),
     {"failed", "no start"}},
    {"no parameters",
     broken_fit([](json& fit) { fit.erase("parameters"); }),
     {"parameters", "missing"}},
    {"unknown parameter",
     broken_fit([](json& fit) { fit["parameters"][0]["name"] = "mass_lb"; }),
     {"parameters[0].name", "mass_lb", "mass_kg"}},
    {"value that is a text",
     broken_fit([](json& fit) { fit["parameters"][0]["value"] = "60"; }),
     {"parameters[0].value", "60", "a number"}},
};

const std::set<std::string> kFitFiles{"out/fit.json",
                                      "out/fitted.toml",
                                      "out/live.json",
                                      "out/report.html",
                                      "out/residual_tests.json",
                                      "out/scorecard.csv",
                                      "out/parameters.csv",
                                      "out/residuals/sine.csv",
                                      "out/residuals/square.csv",
                                      "out/rigcal-manifest.json"};

/// Files of an unfinished search. They do not include the rig for the page, because it is not
/// determined.
std::set<std::string> unfinished_files() {
  std::set<std::string> files = kFitFiles;
  files.erase("out/live.json");
  return files;
}

std::set<std::string> files_in(const CommandFolder& folder, const std::string& prefix) {
  std::set<std::string> found;
  for (const std::string& name : folder.files()) {
    if (name.rfind(prefix, 0) == 0) found.insert(name);
  }
  return found;
}

/// Returns the part of a result that must not depend on threads or time.
json reproducible(const CommandFolder& folder, const std::string& file) {
  json result = json::parse(folder.read(file));
  result.erase("wall_seconds");
  result["provenance"].erase("command");
  return result;
}

/// Adds forty conditions whose simulation takes many seconds.
std::string with_long_conditions(std::string campaign) {
  for (int i = 0; i < 40; ++i) {
    campaign += "\n[[condition]]\nid = \"fast_" + std::to_string(i) +
                "\"\nwaveform = \"square\"\nfrequency = \"99999 Hz\"\namplitude = \"4 mm\"\n"
                "leak_level = \"none\"\nuse = \"validate\"\nrepeats = [\"records/square_*.csv\"]\n";
  }
  return campaign;
}

const Edits kNoRecords{
    {"use = \"fit\"", "use = \"fit\"\nduration = \"1 s\"\nsample_rate = \"100 Hz\""},
    {"repeats = [\"records/sine_*.csv\"]\n", ""},
    {"use = \"validate\"", "use = \"ignore\""}};

}  // namespace

TEST_CASE("rigcal: a bad campaign is refused with its place", "[apps]") {
  for (const BadCampaign& bad : kBadCampaigns) {
    DYNAMIC_SECTION(bad.name) {
      const CommandFolder folder;
      write_campaign(folder, bad.edits);
      check_bad_input(folder, {"fit", "campaign.toml"}, bad.message);
    }
  }
}

TEST_CASE("rigcal: a bad record is refused with its place", "[apps]") {
  for (const BadRecord& bad : kBadRecords) {
    DYNAMIC_SECTION(bad.name) {
      const CommandFolder folder;
      write_campaign(folder);
      folder.write("records/sine_1.csv", bad.content);
      for (const char* verb : {"check", "average", "fit"}) {
        check_bad_input(folder, {verb, "campaign.toml"}, bad.message);
      }
    }
  }
}

TEST_CASE("rigcal: a bad call is refused", "[apps]") {
  for (const BadCall& bad : kBadCalls) {
    std::string name = "rigcal";
    for (const std::string& argument : bad.arguments) name += " " + argument;
    DYNAMIC_SECTION(name) {
      const CommandFolder folder;
      write_campaign(folder);
      check_bad_input(folder, bad.arguments, bad.message);
    }
  }
}

TEST_CASE("validate: a bad fit.json is refused with its place", "[apps]") {
  for (const BadFit& bad : kBadFits) {
    DYNAMIC_SECTION(bad.name) {
      const CommandFolder folder;
      write_campaign(folder);
      folder.write("fit.json", bad.content);
      check_bad_input(folder, {"validate", "campaign.toml", "--fit", "fit.json"}, bad.message);
    }
  }
}

TEST_CASE("fit: what cannot be fitted is refused", "[apps]") {
  const CommandFolder folder;
  SECTION("no parameter is free") {
    write_campaign(folder, {{"upper = \"1e5 N s/m\", fit = true", "upper = \"1e5 N s/m\""},
                            {"upper = \"1e-3 m/V\", fit = true", "upper = \"1e-3 m/V\""}});
    check_bad_input(folder, {"fit", "campaign.toml"}, {"campaign.toml", "fit = true"});
  }
  SECTION("no condition to fit") {
    write_campaign(folder, {{"use = \"fit\"", "use = \"validate\""}});
    check_bad_input(folder, {"fit", "campaign.toml"}, {"campaign.toml", "\"fit\""});
  }
  SECTION("a condition without a record") {
    write_campaign(folder, {{"repeats = [\"records/sine_*.csv\"]\n", ""}});
    check_bad_input(folder, {"fit", "campaign.toml"}, {"campaign.toml:31", "sine", "repeats"});
  }
}

TEST_CASE("rigcal: --out that cannot be written is told before any work", "[apps]") {
  for (const char* verb : {"average", "simulate", "fit", "validate"}) {
    DYNAMIC_SECTION(verb) {
      const CommandFolder folder;
      write_campaign(folder);
      folder.write("occupied", "a file");
      const auto before = folder.files();
      for (const auto& [out, why] :
           {std::pair{"occupied", "is a file; expected a folder"},
            std::pair{"occupied/below", "cannot"}, std::pair{"/dev/null/below", "cannot"}}) {
        const Outcome outcome = folder.run({verb, "campaign.toml", "--out", out});
        CAPTURE(out, outcome.err);
        CHECK(outcome.exit_code == 5);
        CHECK_THAT(outcome.err, StartsWith("rigcal: ") && Contains(out) && Contains(why));
        CHECK(folder.files() == before);
        CHECK(folder.read("occupied") == "a file");
      }
    }
  }
}

TEST_CASE("rigcal: standard output that is full is an error", "[apps]") {
  const CommandFolder folder;
  const Outcome outcome = folder.run({"params"}, "/dev/full");
  CHECK(outcome.exit_code == 5);
  CHECK_THAT(outcome.err, Contains("standard output"));
  // A short text fits into the buffer of the stream, and fails only when that is flushed.
  REQUIRE(folder.run({"schema", "campaign", "--table", "fit"}).out.size() < 4000);
  CHECK(folder.run({"schema", "campaign", "--table", "fit"}, "/dev/full").exit_code == 5);
}

TEST_CASE("rigcal: a result records the command so that a shell reads it back", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  folder.run({"validate", "campaign.toml", "--set", "mass=60 kg", "--out", "it's", "--quiet"});
  CHECK(json::parse(folder.read("it's/validation.json"))["provenance"]["command"] ==
        "rigcal validate campaign.toml --set 'mass=60 kg' --out 'it'\\''s' --quiet");
}

TEST_CASE("rigcal: a result never replaces what it was made from", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  folder.write("truth.toml", kCampaign + kSynthetic);
  folder.write("campaign.toml", kCampaign + kSynthetic);
  const auto before = folder.files();
  const Outcome outcome = folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "."});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("would replace the input campaign.toml"));
  CHECK(folder.files() == before);
  CHECK(folder.read("campaign.toml") == kCampaign + kSynthetic);
}

TEST_CASE("rigcal: help and version", "[apps]") {
  const CommandFolder folder;
  const Outcome version = folder.run({"--version"});
  CHECK(version.exit_code == 0);
  CHECK_THAT(version.out, StartsWith("rigcal 0."));
  const Outcome help = folder.run({"--help"});
  CHECK(help.exit_code == 0);
  for (const char* verb :
       {"check", "average", "simulate", "fit", "validate", "leak-table", "fit-tables", "explore",
        "export", "synthesize", "init", "params", "schema"}) {
    CHECK_THAT(help.out, Contains(verb));
    const Outcome of_verb = folder.run({verb, "--help"});
    CHECK(of_verb.exit_code == 0);
    CHECK_THAT(of_verb.out, Contains("--json"));
    CHECK(of_verb.err.empty());
  }
  CHECK(folder.files().empty());
}

TEST_CASE("params: every parameter with unit and limits", "[apps]") {
  const CommandFolder folder;
  const Outcome text = folder.run({"params"});
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.out, Contains("bulk_modulus") && Contains("V/(m s)") && Contains("eq. 13"));
  const Outcome outcome = folder.run({"params", "--json"});
  const json table = json::parse(outcome.out)["load_pressure"];
  CHECK(table.size() > 30);
  CHECK(table[0]["key"] == "mass");
  CHECK(table[0]["name"] == "mass_kg");
  CHECK(table[0]["default"].is_null());
  CHECK(folder.run({"params", "--quiet"}).out.empty());
}

TEST_CASE("schema: that of campaign files, and the keys of a table", "[apps]") {
  const CommandFolder folder;
  const Outcome printed = folder.run({"schema", "campaign"});
  CHECK(printed.exit_code == 0);
  const json schema = json::parse(printed.out);
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["properties"]["fit"]["properties"]["starts"]["default"] == 1);
  CHECK(folder.run({"schema", "campaign", "--json"}).out == printed.out);
  CHECK_THAT(
      folder.run({"schema", "campaign", "--table", "fit"}).out,
      StartsWith("| key | type |") && Contains("| `starts` | whole number, 1 to 100000 | `1` |"));
  CHECK_THAT(folder.run({"schema", "campaign", "--table", ""}).out, Contains("| `rig` | table |"));
  const Outcome none = folder.run({"schema", "campaign", "--table", "fits"});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.err, Contains("--table fits: no such table"));
  CHECK(folder.run({"schema"}).exit_code == 2);
  CHECK(folder.run({"schema", "result"}).exit_code == 2);
}

TEST_CASE("check: one line per record, and nothing written", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const auto before = folder.files();
  const Outcome text = folder.run({"check", "campaign.toml"});
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.out, Contains("sine: fit, 400 samples at 200 Hz, 1.995 s, 2 repeats") &&
                           Contains("square: validate") && Contains("2 files"));
  const json records = json::parse(folder.run({"check", "campaign.toml", "--json"}).out)["records"];
  CHECK(records.size() == 2);
  CHECK(records[0]["channels"]["position"]["repeats"] == 2);
  CHECK(folder.run({"check", "campaign.toml", "--quiet"}).out.empty());
  CHECK(folder.files() == before);
}

TEST_CASE("average: mean, sd and count, and the repeatability", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const Outcome outcome = folder.run({"average", "campaign.toml", "--out", "out"});
  CHECK(outcome.exit_code == 0);
  CHECK(files_in(folder, "out/") ==
        std::set<std::string>{"out/rigcal-manifest.json", "out/average.json",
                              "out/averaged/sine.csv", "out/averaged/square.csv",
                              "out/repeatability.csv", "out/report.html"});
  CHECK_THAT(folder.read("out/averaged/sine.csv"),
             StartsWith("time_s,") && Contains("position_m_mean,position_m_sd,position_m_count"));
  CHECK_THAT(folder.read("out/repeatability.csv"),
             Contains("noise_floor_rho2") && Contains("\nsine,position,m,2,"));
  const json average = json::parse(folder.read("out/average.json"));
  CHECK(average["schema"] == "rigcal.average/1");
  CHECK(violations(average, "average") == "");
  CHECK(average["records"].size() == 2);
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("id=\"repeatability\"") && Contains("mean and standard deviation"));
  CHECK(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
  // A mean that was changed later does not belong to the result any more.
  folder.write("out/averaged/sine.csv", "time_s\n0\n");
  const Outcome changed = folder.run({"report", "out"});
  CHECK(changed.exit_code == 2);
  CHECK_THAT(changed.err, Contains("averaged/sine.csv") && Contains("was changed"));
}

TEST_CASE("simulate: runs without records", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kNoRecords));
  const Outcome outcome = folder.run({"simulate", "campaign.toml", "--out", "out"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(files_in(folder, "out/") ==
        std::set<std::string>{"out/rigcal-manifest.json", "out/sine.csv"});
  const std::string csv = folder.read("out/sine.csv");
  CHECK_THAT(csv, StartsWith("time_s,reference_m,position_m,velocity_m_per_s,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 102);  // header, and both ends of 1 s
}

TEST_CASE("simulate: --set changes a value as the campaign file would", "[apps]") {
  const CommandFolder folder;
  const std::string campaign = edited(kCampaign, kNoRecords);
  folder.write("campaign.toml", campaign);
  folder.write("changed.toml", replaced(campaign, "\"60 kg\"", "\"90 kg\""));
  const auto simulated = [&](const CommandFolder::Arguments& arguments) {
    CommandFolder::Arguments all{"simulate", "--out", "out", "--quiet"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    CHECK(folder.run(all).exit_code == 0);
    return folder.read("out/sine.csv");
  };
  const std::string set = simulated({"campaign.toml", "--set", "mass=90 kg"});
  CHECK(set == simulated({"changed.toml"}));
  CHECK(set != simulated({"campaign.toml"}));
}

TEST_CASE("simulate: a signal ends it as stopped, and leaves no empty folder", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  folder.write("campaign.toml", with_long_conditions(kCampaign));
  // The folder is made just before the simulations, which take many seconds.
  const Outcome outcome =
      folder.run_and_signal_at({"simulate", "campaign.toml", "--out", "out"}, "out", SIGTERM);
  CHECK(outcome.exit_code == 4);
  CHECK_FALSE(folder.has("out"));
}

TEST_CASE("simulate: what fails says so at its top, the others are written", "[apps]") {
  const CommandFolder folder;
  // A controller with this gain needs steps that the time limit does not allow.
  folder.write("campaign.toml",
               edited(kCampaign, kNoRecords) + "[simulation]\nmax_seconds = 1e-6\n");
  const Outcome outcome = folder.run({"simulate", "campaign.toml", "--out", "out"});
  CHECK(outcome.exit_code == 3);
  CHECK_THAT(outcome.err, StartsWith("rigcal: sine: "));
  CHECK_THAT(folder.read("out/sine.csv"), StartsWith("# status: failed: "));
}

TEST_CASE("fit and validate: a twin from its records to its verdict", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const Outcome outcome = folder.run({"fit", "twin/campaign.toml", "--out", "out"});
  CAPTURE(outcome.err, outcome.out);
  REQUIRE(outcome.exit_code == 0);
  CHECK(files_in(folder, "out/") == kFitFiles);
  CHECK_THAT(outcome.out, StartsWith("PASS: ") && Contains("Damping"));

  check_complete(folder.read("out/fit.json"));
  const json fit = json::parse(folder.read("out/fit.json"));
  CHECK(fit["schema"] == "rigcal.fit/2");
  CHECK(fit["status"] == "converged");
  CHECK(fit["verdict"] == "PASS");
  CHECK(fit["synthetic"] == true);
  const double freedom = fit["residual_count"].get<double>() - fit["rank"].get<double>();
  CHECK_THAT(fit["reduced_chi_square"].get<double>(),
             Catch::WithinRel(2.0 * fit["cost"].get<double>() / freedom, 1e-12));
  for (const json& parameter : fit["parameters"]) {
    if (parameter["name"] == "damping_n_s_per_m") {
      // Noise of 0.2 % leaves an uncertainty of 0.2 %. At 3.5 standard errors the test fails once
      // in two thousand draws.
      const double standard_error = parameter["standard_error"].get<double>();
      CHECK(standard_error < 3.0);
      CHECK_THAT(parameter["value"].get<double>(), Catch::WithinAbs(1000.0, 3.5 * standard_error));
    }
  }
  CHECK(fit["provenance"]["inputs"].size() == 7);  // the campaign and 2 x 3 repeats
  CHECK(fit["provenance"]["inputs"][0]["sha256"].get<std::string>().size() == 64);
  CHECK_THAT(folder.read("out/residuals/sine.csv"), StartsWith("time_s,measured_position_m,"));

  {
    INFO("the report is drawn again to the same bytes");
    const std::string page = folder.read("out/report.html");
    CHECK(folder.run({"report", "out", "--figures", "--threads", "1"}).exit_code == 2);
    CHECK(folder.run({"report", "out", "--figures", "--quiet"}).exit_code == 0);
    CHECK(folder.read("out/report.html") == page);
    CHECK_THAT(folder.read("out/figures/sine_position.svg"), StartsWith("<svg xmlns="));
    CHECK(folder.run({"report", "twin"}).exit_code == 2);
  }
  {
    INFO("the same numbers for any number of threads");
    folder.run({"fit", "twin/campaign.toml", "--out", "one", "--threads", "1", "--quiet"});
    folder.run({"fit", "twin/campaign.toml", "--out", "four", "--threads", "4", "--quiet"});
    CHECK(reproducible(folder, "one/fit.json") == reproducible(folder, "four/fit.json"));
    CHECK(folder.read("one/fitted.toml") == folder.read("four/fitted.toml"));
    CHECK(folder.read("one/scorecard.csv") == folder.read("four/scorecard.csv"));
  }
  {
    INFO("validation with the fit");
    const Outcome validation = folder.run(
        {"validate", "twin/campaign.toml", "--fit", "out/fit.json", "--out", "val", "--json"});
    CHECK(validation.exit_code == 0);
    CHECK(json::parse(validation.out) == json::parse(folder.read("val/validation.json")));
    CHECK_FALSE(folder.has("val/fitted.toml"));
    CHECK_THAT(validation.out, Contains("rigcal.validation/1"));
    check_complete(validation.out);
    check_page_of_files(folder, "val");
    // The prediction band equals that of the fit, because fit.json contains errors and
    // correlations.
    const auto theirs = column(folder.read("out/residuals/square.csv"), "prediction_sd_position_m");
    const auto ours = column(folder.read("val/residuals/square.csv"), "prediction_sd_position_m");
    REQUIRE(theirs.size() == ours.size());
    REQUIRE(theirs.size() > 300);
    for (std::size_t i = 0; i < ours.size(); ++i)
      CHECK_THAT(ours[i], Catch::WithinRel(theirs[i], 0.02));
  }
  {
    INFO("validation of what the fit does not cover is warned of");
    folder.write("twin/far.toml",
                 edited(folder.read("twin/campaign.toml"), {{"\"5 mm\"", "\"9 mm\""}}));
    const Outcome validation =
        folder.run({"validate", "twin/far.toml", "--fit", "out/fit.json", "--out", "far"});
    CHECK_THAT(validation.out, Contains("warning: amplitude 4 to 9 mm is used, but the fit covers "
                                        "only 5 mm,"));
  }
  {
    INFO("the campaign that was fitted can be used at once");
    const Outcome validation = folder.run({"validate", "out/fitted.toml", "--out", "used", "-v"});
    CAPTURE(validation.err);
    CHECK(validation.exit_code == 0);
    CHECK_THAT(validation.out, Contains("Nothing was estimated."));
    CHECK(folder.read("used/residuals/square.csv").find("prediction_sd") == std::string::npos);
  }
  {
    INFO("a verdict of FAIL is an exit code");
    const Outcome validation = folder.run(
        {"validate", "twin/campaign.toml", "--set", "valve_gain=1e-6 m/V", "--out", "failed"});
    CHECK(validation.exit_code == 1);
    CHECK_THAT(validation.out, StartsWith("FAIL: "));
    CHECK(json::parse(folder.read("failed/validation.json"))["verdict"] == "FAIL");
  }
  {
    INFO("quiet is quiet");
    const Outcome quiet = folder.run({"fit", "twin/campaign.toml", "--out", "q", "--quiet"});
    CHECK(quiet.exit_code == 0);
    CHECK(quiet.out.empty());
    CHECK(quiet.err.empty());
  }
}

TEST_CASE("validate: a leak level that the fit does not have is an error", "[apps]") {
  const CommandFolder folder;
  const Edits per_level{{"leakage_coefficient = 0.3",
                         "leakage_coefficient = { start = 0.3, lower = 0, upper = 5, fit = true, "
                         "scope = \"leak_level\" }"}};
  REQUIRE(write_twin(folder, per_level).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "out"}).exit_code == 0);
  std::string other = folder.read("twin/campaign.toml");
  for (std::size_t at = other.find("none"); at != std::string::npos; at = other.find("none", at)) {
    other.replace(at, 4, "open");
  }
  folder.write("twin/other.toml", other);
  check_bad_input(folder, {"validate", "twin/other.toml", "--fit", "out/fit.json"},
                  {"twin/other.toml:", "open", "none"});
}

TEST_CASE("fit: stopped by a signal it keeps the best so far", "[apps]") {
  for (const int signal : {SIGINT, SIGTERM}) {
    DYNAMIC_SECTION("signal " << signal) {
      const CommandFolder folder;
      REQUIRE(write_twin(folder).exit_code == 0);
      const Outcome outcome = folder.run_and_signal(
          {"fit", "twin/campaign.toml", "--out", "out", "--starts", "5000", "--max-time", "600"},
          "iteration", signal);
      CAPTURE(outcome.err);
      CHECK(outcome.exit_code == 4);
      CHECK_THAT(outcome.err, Contains(", iteration ") && Contains(" left\n"));
      auto files = files_in(folder, "out/");
      files.erase("out/checkpoint.json");  // exists once a start is completed
      CHECK(files == unfinished_files());
      CHECK(json::parse(folder.read("out/fit.json"))["status"] == "stopped");
      check_complete(folder.read("out/fit.json"));
      CHECK_THAT(folder.read("out/fit.json"), StartsWith("{\n  \"status\": \"stopped\""));
      for (const char* file : {"out/scorecard.csv", "out/parameters.csv", "out/residuals/sine.csv",
                               "out/fitted.toml"}) {
        CHECK_THAT(folder.read(file), StartsWith("# status: stopped"));
      }
    }
  }
}

TEST_CASE("validate: a signal ends the scoring of conditions that are long to simulate", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "one", "--quiet"}).exit_code == 0);
  folder.write("twin/campaign.toml", with_long_conditions(folder.read("twin/campaign.toml")));
  // The folder is made just before the simulations, which take many seconds.
  const Outcome outcome = folder.run_and_signal_at(
      {"validate", "twin/campaign.toml", "--fit", "one/fit.json", "--out", "out"}, "out", SIGTERM);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 4);
  const json validation = json::parse(folder.read("out/validation.json"));
  CHECK(validation["status"] == "stopped");
  CHECK(validation["stopped_in"] == "validation");
  int unscored = 0;
  for (const json& condition : validation["conditions"]) {
    if (condition["not_scored"].is_null()) continue;
    ++unscored;
    CHECK_THAT(condition["not_scored"].get<std::string>(), Contains("stopped on request"));
    CHECK(condition["failure"].is_null());
  }
  CHECK(unscored > 0);
}

TEST_CASE("fit: stopped by a limit of iterations it says so", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  folder.write("twin/short.toml",
               folder.read("twin/campaign.toml") + "\n[fit]\nmax_iterations = 1\n");
  const Outcome outcome = folder.run({"fit", "twin/short.toml", "--out", "out"});
  CHECK(outcome.exit_code == 4);
  CHECK(files_in(folder, "out/") == unfinished_files());
  CHECK_THAT(outcome.out, StartsWith("STOPPED: ") && Contains("not judged"));
  CHECK_THAT(outcome.out, !Contains("identified"));
  check_complete(folder.read("out/fit.json"));
  check_page_of_files(folder, "out");
  const json fit = json::parse(folder.read("out/fit.json"));
  for (const json& parameter : fit["parameters"]) {
    if (!parameter["fitted"].get<bool>()) continue;
    CHECK(parameter["identifiability"] == "not_identifiable");
    CHECK_THAT(parameter["reason"].get<std::string>(), StartsWith("not judged: the search was"));
  }
  const Outcome validation =
      folder.run({"validate", "twin/campaign.toml", "--fit", "out/fit.json", "--out", "val"});
  CHECK_THAT(validation.out, Contains("warning: the fit was stopped before it converged"));
}

TEST_CASE("fit: what cannot be simulated gives no parameters", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  folder.write("twin/hopeless.toml",
               folder.read("twin/campaign.toml") + "\n[simulation]\nmax_seconds = 1e-6\n");
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "out", "--quiet"}).exit_code == 0);
  REQUIRE(folder.has("out/fitted.toml"));
  const Outcome outcome = folder.run({"fit", "twin/hopeless.toml", "--out", "out"});
  CAPTURE(outcome.err, outcome.out);
  CHECK(outcome.exit_code == 3);
  std::set<std::string> expected = unfinished_files();
  expected.erase("out/fitted.toml");
  CHECK(files_in(folder, "out/") == expected);
  CHECK_THAT(folder.read("out/fit.json"), StartsWith("{\n  \"status\": \"failed\""));
  CHECK_THAT(folder.read("out/scorecard.csv"), StartsWith("# status: failed: "));
  CHECK_THAT(folder.read("out/parameters.csv"), StartsWith("# status: failed: "));
  CHECK_THAT(folder.read("out/residuals/sine.csv"), StartsWith("# status: failed: "));
  CHECK_THAT(folder.read("out/report.html"), Contains("<title>FAILED"));
  check_page_of_files(folder, "out");
  check_complete(folder.read("out/fit.json"));
  check_bad_input(folder, {"validate", "twin/campaign.toml", "--fit", "out/fit.json"}, {"failed"});
}
