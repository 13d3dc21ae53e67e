#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "report/json.hpp"
#include "report/read_json.hpp"

namespace rigcal::report {
namespace {

using datasets::FittedValue;
using datasets::Scope;

constexpr const char* kTruthSchema = "rigcal.truth/1";

/// One value of the file, with its place in words.
class Node {
 public:
  Node(const Json& json, const std::string& file, std::string path)
      : json_(json), file_(file), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(
        {file_}, fmt::format("key '{}': found {}, expected {}", path_,
                             shortened(json_.dump(-1, ' ', false, Json::error_handler_t::replace)),
                             expected));
  }

  Node operator[](const std::string& key) const {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!json_.is_object()) fail("an object");
    const auto found = json_.find(key);
    if (found == json_.end()) {
      throw InputError({file_}, fmt::format("key '{}' is missing; is this a fit.json?", path));
    }
    return {*found, file_, path};
  }

  std::vector<Node> items() const {
    if (!json_.is_array()) fail("a list");
    std::vector<Node> result;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      result.emplace_back(json_[i], file_, fmt::format("{}[{}]", path_, i));
    }
    return result;
  }

  /// Members that are numbers; null stands for one that is not finite, and is left out.
  std::vector<std::pair<std::string, double>> numbers() const {
    if (!json_.is_object()) fail("an object");
    std::vector<std::pair<std::string, double>> result;
    for (const auto& [key, value] : json_.items()) {
      const Node member(value, file_, path_ + "." + key);
      if (!member.is_null()) result.emplace_back(key, member.real());
    }
    return result;
  }

  bool is_null() const { return json_.is_null(); }
  std::string string() const {
    if (!json_.is_string()) fail("a text");
    return json_.get<std::string>();
  }
  bool boolean() const {
    if (!json_.is_boolean()) fail("true or false");
    return json_.get<bool>();
  }
  double real() const {
    if (!json_.is_number()) fail("a number");
    return json_.get<double>();
  }
  std::optional<Range> range() const {
    if (is_null()) return std::nullopt;
    const std::vector<Node> ends = items();
    if (ends.size() != 2) fail("two numbers, or null");
    return Range{ends[0].real(), ends[1].real()};
  }

 private:
  static std::string shortened(std::string text) {
    constexpr std::size_t kLongest = 40;
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return text;
  }

  const Json& json_;
  std::string file_;
  std::string path_;
};

template <typename Enum, std::size_t N>
Enum one_of(const Node& node, const std::array<Enum, N>& values) {
  const std::string text = node.string();
  std::string names;
  for (const Enum value : values) {
    if (to_string(value) == text) return value;
    names += std::string(names.empty() ? "" : ", ") + std::string(to_string(value));
  }
  node.fail("one of " + names);
}

int index_of(const Node& name, model::PlantKind plant) {
  const auto table = model::parameter_table(plant);
  const std::string text = name.string();
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const model::ParameterSpec& s) { return s.name == text; });
  if (found == table.end()) {
    std::vector<std::string> known;
    for (const model::ParameterSpec& spec : table) known.emplace_back(spec.name);
    const std::string near = nearest_name(text, known);
    name.fail(fmt::format("a parameter of the plant {}{}", to_string(plant),
                          near.empty() ? "" : " such as " + near));
  }
  return static_cast<int>(found - table.begin());
}

Validity read_validity(const Node& node) {
  Validity validity;
  validity.frequency_hz = node["frequency_hz"].range();
  const Node amplitude_m = node["amplitude_m"];
  validity.amplitude = amplitude_m.is_null() ? node["amplitude_v"].range() : amplitude_m.range();
  validity.supply_pressure_pa = node["supply_pressure_pa"].range();
  validity.leakage_coefficient = node["leakage_coefficient"].range();
  for (const Node& level : node["leak_levels"].items()) {
    validity.leak_levels.push_back(level.string());
  }
  return validity;
}

/// Standard error of an entry of `parameters`: the larger of the two; empty where there is none.
std::optional<double> standard_error(const Node& entry) {
  std::optional<double> largest;
  for (const char* key : {"standard_error", "robust_standard_error"}) {
    const Node error = entry[key];
    if (!error.is_null()) largest = std::max(largest.value_or(0.0), error.real());
  }
  return largest;
}

void read_covariance(const Node& root, model::PlantKind plant, EarlierFit& fit) {
  const auto names = root["correlation"]["names"].items();
  const auto rows = root["correlation"]["matrix"].items();
  std::vector<std::size_t> places;
  std::vector<double> errors;
  for (const Node& entry : root["parameters"].items()) {
    if (!entry["fitted"].boolean() || entry["nuisance"].boolean()) continue;
    if (one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition}) !=
        Scope::rig)
      continue;
    const std::string name = entry["name"].string();
    const auto place = std::find_if(names.begin(), names.end(),
                                    [&](const Node& each) { return each.string() == name; });
    const auto error = standard_error(entry);
    if (!error || place == names.end()) continue;
    fit.indices.push_back(index_of(entry["name"], plant));
    places.push_back(static_cast<std::size_t>(place - names.begin()));
    errors.push_back(*error);
  }
  const auto n = static_cast<Eigen::Index>(places.size());
  fit.covariance.resize(n, n);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] >= rows.size()) root["correlation"]["matrix"].fail("one row per name");
    const auto row = rows[places[i]].items();
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (places[j] >= row.size()) rows[places[i]].fail("one number per name");
      fit.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          row[places[j]].real() * errors[i] * errors[j];
    }
  }
}

/// What a fit of before there were assessments does not have.
calib::Aspect no_assessment() {
  calib::Aspect aspect;
  aspect.reasons.push_back({calib::AspectState::not_assessed,
                            "no_assessment",
                            "",
                            {},
                            "the fit.json of the values holds no assessment of its parameters"});
  return aspect;
}

calib::Aspect read_aspect(const Node& node) {
  using calib::AspectState;
  const std::array states{AspectState::pass, AspectState::reservation, AspectState::fail,
                          AspectState::not_assessed};
  calib::Aspect aspect;
  aspect.state = one_of(node["state"], states);
  for (const Node& entry : node["reasons"].items()) {
    calib::Reason& reason = aspect.reasons.emplace_back();
    reason.state = one_of(entry["state"], states);
    reason.code = entry["code"].string();
    if (!entry["subject"].is_null()) reason.subject = entry["subject"].string();
    reason.words = entry["words"].string();
    reason.numbers = entry["numbers"].numbers();
  }
  return aspect;
}

void read_origin(const Json& json, const Node& root, EarlierFit& fit) {
  using datasets::Use;
  for (const Node& entry : root["conditions"].items()) {
    fit.conditions.emplace_back(
        entry["id"].string(),
        one_of(entry["use"], std::array{Use::fit, Use::validate, Use::diagnose, Use::ignore}));
  }
  for (const Node& input : root["provenance"]["inputs"].items())
    fit.input_hashes.push_back(input["sha256"].string());
  fit.parameters =
      json.contains("assessment") ? read_aspect(root["assessment"]["parameters"]) : no_assessment();
}

}  // namespace

EarlierFit read_fit(const std::filesystem::path& file, model::PlantKind plant) {
  const std::string name = file.string();
  const Json json = read_json(file, "the fit.json of an earlier fit");
  const Node root(json, name, "");
  if (!json.is_object()) {
    throw InputError({name}, "found no JSON object, expected the fit.json of an earlier fit");
  }
  if (root["schema"].string() != kFitSchema) {
    root["schema"].fail(fmt::format("\"{}\"", kFitSchema));
  }
  using calib::FitStatus;
  EarlierFit result;
  result.status = one_of(root["status"],
                         std::array{FitStatus::converged, FitStatus::stopped, FitStatus::failed});
  result.message = root["message"].string();
  if (result.status == FitStatus::failed) {
    throw InputError({name}, fmt::format("this fit failed ({}), its values mean nothing; expected "
                                         "one that converged",
                                         result.message));
  }
  for (const Node& entry : root["parameters"].items()) {
    FittedValue value;
    value.index = index_of(entry["name"], plant);
    value.scope =
        one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition});
    if (value.scope != Scope::rig) value.level = entry["level"].string();
    const bool fitted = entry["fitted"].boolean();
    // A nuisance parameter belongs to the records of its fit.
    if (entry["nuisance"].boolean() || (!fitted && entry["value"].is_null())) continue;
    value.value = entry["value"].real();
    if (fitted) {
      result.values.push_back(std::move(value));
    } else if (value.scope == Scope::rig) {
      result.known.push_back(std::move(value));
    }
  }
  result.validity = read_validity(root["validity"]);
  read_covariance(root, plant, result);
  read_origin(json, root, result);
  return result;
}

std::vector<FittedValue> read_truth(const std::filesystem::path& file, model::PlantKind plant) {
  const Json json = read_json(file, "the truth.json of a synthetic campaign");
  const Node root(json, file.string(), "");
  if (root["schema"].string() != kTruthSchema)
    root["schema"].fail(fmt::format("\"{}\"", kTruthSchema));
  std::vector<FittedValue> values;
  for (const Node& entry : root["parameters"].items()) {
    if (!entry["given"].boolean()) continue;
    FittedValue value;
    value.index = index_of(entry["name"], plant);
    value.scope =
        one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition});
    if (value.scope != Scope::rig) value.level = entry["level"].string();
    value.value = entry["value"].real();
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace rigcal::report
