#include "model/fmi/exported_rig.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace rigcal::model {
namespace {

constexpr std::string_view kFirstLine = "rigcal.rig/1";

constexpr std::array<std::pair<std::string_view, Before>, 3> kBefore{
    {{"hold", Before::hold}, {"rest", Before::rest}, {"steady", Before::steady}}};

/// Writes the fewest digits from which the same bits can be read back.
std::string all_digits(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// Reads one line of the file: a key, then words.
class Line {
 public:
  Line(const std::filesystem::path& file, int number, const std::string& text)
      : where_(file.string() + ":" + std::to_string(number) + ": "), words_(text) {}

  std::string word(const char* expected) {
    std::string word;
    if (!(words_ >> word)) fail("end of line", expected);
    return word;
  }

  double number() {
    const std::string text = word("a number");
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end || !std::isfinite(value)) fail(text, "a number");
    return value;
  }

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw std::runtime_error(where_ + "found " + found + ", expected " + expected);
  }

 private:
  std::string where_;
  std::istringstream words_;
};

void read_parameter(Line& line, ParameterValues& values) {
  const std::string key = line.word("a parameter");
  const int index = parameter_index(values.plant, key);
  if (index < 0) line.fail(key, "a parameter of " + std::string(to_string(values.plant)));
  values.set(index, line.number());
}

void read_plant(Line& line, ExportedRig& rig) {
  const std::string name = line.word("a plant");
  const auto plant = plant_from_name(name);
  if (!plant) line.fail(name, "a plant");
  rig.rig.plant = *plant;
  rig.values = ParameterValues::defaults(*plant);
}

void read_feedback(Line& line, ExportedRig& rig) {
  const std::string name = line.word("the controlled quantity");
  const auto row = std::find_if(kFeedbacks.begin(), kFeedbacks.end(),
                                [&](const FeedbackRow& each) { return each.name == name; });
  if (row == kFeedbacks.end()) line.fail(name, "the controlled quantity");
  rig.rig.feedback = static_cast<Feedback>(row - kFeedbacks.begin());
}

bool read_choice(Line& line, const char* yes, const char* no) {
  const std::string word = line.word(yes);
  if (word != yes && word != no) line.fail(word, std::string(yes) + " or " + no);
  return word == yes;
}

}  // namespace

bool is_input(const ParameterSpec& spec) {
  return spec.key == "external_force" || spec.key == "supply_pressure" ||
         spec.key == "tank_pressure";
}

bool is_tunable(const ParameterSpec& spec) {
  return spec.kind != ParameterKind::initial && spec.key != "sample_time";
}

std::vector<int> exported_parameters(const ExportedRig& rig) {
  const auto table = parameter_table(rig.rig.plant);
  const bool pid = rig.rig.controller == ControllerKind::pid;
  const bool starts_from_values = rig.rig.initial == InitialState::given;
  std::vector<int> indices;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const ParameterSpec& spec = table[i];
    if (is_input(spec) || spec.key == "transport_delay") continue;
    const bool given = rig.values.given[i];
    const auto taken = [&] {
      switch (spec.kind) {
        case ParameterKind::plant:
          return true;
        case ParameterKind::term:
          return given;
        case ParameterKind::controller:
          return pid && given;
        case ParameterKind::initial:
          return starts_from_values && given;
        case ParameterKind::sensor:
          return false;
      }
      return false;
    };
    if (taken()) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

std::string exported_rig_text(const ExportedRig& rig) {
  const auto table = parameter_table(rig.rig.plant);
  std::string text(kFirstLine);
  text += "\nguid " + rig.guid + "\nplant " + std::string(to_string(rig.rig.plant));
  text += rig.rig.controller == ControllerKind::pid ? "\ncontroller pid" : "\ncontroller none";
  text += "\nfeedback " + std::string(gain_keys(rig.rig.feedback).name);
  text += rig.rig.initial == InitialState::given ? "\ninitial given" : "\ninitial rest";
  for (const auto& [name, before] : kBefore)
    if (rig.rig.before == before) text += "\nbefore " + std::string(name);
  text += "\ntolerance " + all_digits(rig.tolerance) + "\n";
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!rig.values.given[i]) continue;
    text += "parameter " + std::string(table[i].key) + " " + all_digits(rig.values.value[i]) + "\n";
  }
  return text;
}

ExportedRig read_exported_rig(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::string text;
  if (!std::getline(in, text) || text != kFirstLine)
    throw std::runtime_error(file.string() + ":1: found \"" + text + "\", expected \"" +
                             std::string(kFirstLine) + "\"");
  ExportedRig rig;
  for (int number = 2; std::getline(in, text); ++number) {
    Line line(file, number, text);
    const std::string key = line.word("a key");
    if (key == "guid") {
      rig.guid = line.word("a GUID");
    } else if (key == "plant") {
      read_plant(line, rig);
    } else if (key == "controller") {
      rig.rig.controller =
          read_choice(line, "pid", "none") ? ControllerKind::pid : ControllerKind::none;
    } else if (key == "feedback") {
      read_feedback(line, rig);
    } else if (key == "initial") {
      rig.rig.initial =
          read_choice(line, "given", "rest") ? InitialState::given : InitialState::rest;
    } else if (key == "before") {
      const std::string word = line.word("hold, rest or steady");
      const auto found = std::find_if(kBefore.begin(), kBefore.end(),
                                      [&word](const auto& row) { return row.first == word; });
      if (found == kBefore.end()) line.fail(word, "hold, rest or steady");
      rig.rig.before = found->second;
    } else if (key == "tolerance") {
      rig.tolerance = line.number();
    } else if (key == "parameter") {
      read_parameter(line, rig.values);
    } else {
      line.fail(key, "guid, plant, controller, feedback, initial, before, tolerance or parameter");
    }
  }
  return rig;
}

}  // namespace rigcal::model
