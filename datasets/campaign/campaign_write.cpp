#include <fmt/format.h>

#include <algorithm>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/design/drive_file.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/campaign/toml/toml_writer.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

/// Returns a table within a table, and creates it if it is missing.
toml::table& child(toml::table& table, std::string_view key, bool is_inline) {
  if (!table.contains(key)) {
    toml::table added;
    added.is_inline(is_inline);
    table.insert(key, std::move(added));
  }
  return *table.get_as<toml::table>(key);
}

/// Sets a key to an exact value, in the unit of the parameter table.
void put(toml::table& table, const model::ParameterSpec& spec, std::string_view key, double value) {
  if (spec.unit == "1") {
    table.insert_or_assign(key, value);
  } else {
    table.insert_or_assign(key, fmt::format("{} {}", toml_number(value), spec.unit));
  }
}

bool of_controller(const model::ParameterSpec& spec) {
  return spec.kind == model::ParameterKind::controller;
}

/// Returns the table for a parameter: [rig.parameters] or [rig.controller].
toml::table& rig_table(toml::table& root, const model::ParameterSpec& spec) {
  return child(child(root, "rig", false), of_controller(spec) ? "controller" : "parameters", false);
}

toml::table* condition_table(toml::table& root, std::string_view id) {
  auto* conditions = root.get_as<toml::array>("condition");
  if (conditions == nullptr) return nullptr;
  for (toml::node& item : *conditions) {
    auto* table = item.as_table();
    if (table != nullptr && (*table)["id"].value_or(std::string_view{}) == id) return table;
  }
  return nullptr;
}

void write_value(toml::table& root, const model::ParameterSpec& spec, const FittedValue& fitted) {
  switch (fitted.scope) {
    case Scope::rig:
      put(rig_table(root, spec), spec, spec.key, fitted.value);
      return;
    case Scope::leak_level: {
      toml::table& level = child(child(root, "leak_level", false), fitted.level, false);
      put(child(level, "parameters", true), spec, spec.key, fitted.value);
      return;
    }
    case Scope::condition: {
      toml::table* condition = condition_table(root, fitted.level);
      if (condition == nullptr) {
        throw std::invalid_argument(fmt::format(
            "fitted_campaign_text: the campaign has no condition \"{}\"", fitted.level));
      }
      put(child(*condition, of_controller(spec) ? "controller" : "parameters", true), spec,
          spec.key, fitted.value);
      return;
    }
  }
}

/// Whether a condition has its own value instead of the rig's: a known value, possibly from its
/// leak level, or a fitted one.
bool has_own_value(const Campaign& campaign, const Condition& condition, int index,
                   const std::vector<FittedValue>& values) {
  if (has_entry(condition.overrides, index)) return true;
  if (condition.leak_level) {
    const auto level = campaign.leak_levels.find(*condition.leak_level);
    if (level != campaign.leak_levels.end() && has_entry(level->second, index)) return true;
  }
  return std::any_of(values.begin(), values.end(), [&](const FittedValue& fitted) {
    if (fitted.index != index) return false;
    return fitted.scope == Scope::condition
               ? fitted.level == condition.id
               : fitted.scope == Scope::leak_level && fitted.level == condition.leak_level;
  });
}

/// Writes the start of a parameter that has a value per leak level or condition. Removes the start
/// if all conditions have their own value. A leak level that was not fitted then causes an error,
/// and the start cannot be mistaken for a result.
void write_scoped_start(toml::table& root, const Campaign& campaign,
                        const ParameterSetting& setting, const std::vector<FittedValue>& values) {
  const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, setting.index);
  const bool everywhere = std::all_of(
      campaign.conditions.begin(), campaign.conditions.end(), [&](const Condition& condition) {
        return has_own_value(campaign, condition, setting.index, values);
      });
  toml::table& table = rig_table(root, spec);
  if (everywhere) {
    table.erase(spec.key);
  } else {
    put(table, spec, spec.key, setting.value);
  }
}

/// Writes a new start for a nuisance parameter, which remains fitted, if it has a single value for
/// the rig.
void write_nuisance_start(toml::table& root, const model::ParameterSpec& spec,
                          const FittedValue& fitted) {
  if (fitted.scope != Scope::rig) return;
  toml::table& table = rig_table(root, spec);
  if (auto* entry = table.get_as<toml::table>(spec.key)) put(*entry, spec, "start", fitted.value);
}

/// Writes known values that --set and --free have changed since the file was read.
void write_changed_values(toml::table& root, const Campaign& campaign) {
  const Campaign original = load_campaign(campaign.file, campaign.data_dir, campaign.root);
  for (const ParameterSetting& setting : campaign.parameters) {
    if (setting.fit) continue;
    const ParameterSetting* before = original.setting(setting.index);
    if (before != nullptr && !before->fit && before->value == setting.value) continue;
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, setting.index);
    put(rig_table(root, spec), spec, spec.key, setting.value);
  }
}

/// Converts a record path relative to `data` to one relative to `out`, or to an absolute path if
/// `out` is empty.
std::string rebased(const std::string& file, const fs::path& data, const fs::path& out) {
  if (fs::path(file).is_absolute()) return file;
  if (out.empty()) return (data / file).lexically_normal().generic_string();
  const fs::path relative = (data / file).lexically_relative(out);
  return (relative.empty() ? data / file : relative).generic_string();
}

void rebase_records(toml::table& root, const fs::path& data, const fs::path& out) {
  const auto rebase = [&](toml::node& node) {
    if (auto* text = node.as_string()) text->get() = rebased(text->get(), data, out);
  };
  auto* conditions = root.get_as<toml::array>("condition");
  if (conditions == nullptr) return;
  for (toml::node& item : *conditions) {
    toml::table& condition = *item.as_table();
    if (auto* averaged = condition.get("averaged")) rebase(*averaged);
    auto* repeats = condition.get_as<toml::array>("repeats");
    if (repeats == nullptr) continue;
    for (toml::node& repeat : *repeats) {
      auto* table = repeat.as_table();
      if (table == nullptr) rebase(repeat);
      if (table != nullptr && table->contains("file")) rebase(*table->get("file"));
    }
  }
}

/// Writes parameters that are fitted because of --free, or whose start --set has changed.
void write_changed_freedom(toml::table& root, const Campaign& campaign) {
  const Campaign original = load_campaign(campaign.file, campaign.data_dir, campaign.root);
  for (const ParameterSetting& setting : campaign.parameters) {
    const ParameterSetting* before = original.setting(setting.index);
    const bool was_free = before != nullptr && before->fit;
    if (setting.fit == was_free && (!setting.fit || before->value == setting.value)) continue;
    if (!setting.fit) continue;  // write_changed_values() wrote it
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, setting.index);
    toml::table& table = rig_table(root, spec);
    if (!table[spec.key].is_table()) {
      toml::table entry;
      entry.is_inline(true);
      table.insert_or_assign(spec.key, std::move(entry));
    }
    toml::table& entry = *table.get_as<toml::table>(spec.key);
    put(entry, spec, "start", setting.value);
    put(entry, spec, "lower", setting.lower);
    put(entry, spec, "upper", setting.upper);
    entry.insert_or_assign("fit", true);
  }
}

/// Writes the channels of a designed test. Each channel keeps the column from the campaign, or gets
/// one named after its key.
void write_designed_channels(toml::table& root, const Campaign& campaign,
                             const std::map<Channel, double>& noise_sd) {
  toml::table& channels = child(child(root, "recording", false), "channels", false);
  const auto add = [&](std::string_view key) -> toml::table& {
    toml::table& entry = child(channels, key, true);
    if (!entry.contains("column")) entry.insert("column", key);
    return entry;
  };
  toml::table& time = child(channels, "time", true);
  if (!time.contains("column")) {
    time.insert("column", "time_s");
    time.insert("unit", "s");
  }
  toml::table& drive = add(info(drive_channel(campaign)).key);
  if (!drive.contains("unit")) drive.insert("unit", drive_unit(campaign).name);
  drive.insert_or_assign("role", "input");
  for (const auto& [channel, sd] : noise_sd) {
    toml::table& entry = add(info(channel).key);
    if (!entry.contains("sd"))
      entry.insert("sd", fmt::format("{} {}", toml_number(sd), info(channel).unit));
  }
}

toml::table designed_condition(toml::table& root, const DesignSettings& design,
                               DriveFamily family) {
  toml::table condition;
  const std::string id = designed_condition_id(family);
  condition.insert("id", id);
  condition.insert("waveform", "recorded");
  condition.insert("use", "fit");
  toml::table* like = design.like ? condition_table(root, *design.like) : nullptr;
  for (const char* key : {"leak_level", "specimen", "parameters", "controller"}) {
    toml::node* value = like == nullptr ? nullptr : like->get(key);
    if (value != nullptr) value->visit([&](const auto& known) { condition.insert(key, known); });
  }
  condition.insert("duration", fmt::format("{} s", toml_number(design.duration_s)));
  toml::array repeats;
  for (int repeat = 1; repeat <= design.repeats; ++repeat)
    repeats.push_back(fmt::format("records/{}_r{}.csv", id, repeat));
  condition.insert("repeats", std::move(repeats));
  return condition;
}

fs::path resolved(const fs::path& folder) {
  return fs::weakly_canonical(fs::absolute(folder.empty() ? fs::path(".") : folder));
}

}  // namespace

std::string fitted_campaign_text(const Campaign& campaign, const std::vector<FittedValue>& values,
                                 const fs::path& out_dir) {
  toml::table root = parse_toml_file(campaign.file);
  write_changed_values(root, campaign);
  for (const FittedValue& fitted : values) {
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, fitted.index);
    const ParameterSetting* setting = campaign.setting(fitted.index);
    if (setting != nullptr && setting->nuisance) {
      write_nuisance_start(root, spec, fitted);
    } else {
      write_value(root, spec, fitted);
      if (setting != nullptr && fitted.scope != Scope::rig) {
        write_scoped_start(root, campaign, *setting, values);
      }
    }
  }
  rebase_records(root, resolved(campaign.data_dir),
                 out_dir.empty() ? fs::path() : resolved(out_dir));
  return fmt::format(
      "# Written by rigcal fit from {}: the fitted values replace the starts.\n"
      "# Nuisance parameters stay free. Record paths start at the folder of this file.\n\n{}",
      toml_quoted(campaign.file.filename().string()), toml_text(root));
}

std::string designed_campaign_text(const Campaign& campaign, const DesignSettings& design,
                                   DriveFamily family, const std::map<Channel, double>& noise_sd) {
  toml::table root = parse_toml_file(campaign.file);
  write_changed_values(root, campaign);
  write_changed_freedom(root, campaign);
  write_designed_channels(root, campaign, noise_sd);
  toml::array conditions;
  conditions.push_back(designed_condition(root, design, family));
  // These sections refer to conditions that are removed, or describe synthetic records.
  for (const char* key : {"condition", "design", "diagnosis", "synthetic"}) root.erase(key);
  root.insert("condition", std::move(conditions));
  return fmt::format(
      "# Written by rigcal plan --design from {}: the test is in design.csv, which the controller\n"
      "# plays. Put the recordings at the paths below, with the columns of [recording.channels]. "
      "The\n"
      "# drive is compared sample by sample: record it as the controller has it, without "
      "noise.\n\n{}",
      toml_quoted(campaign.file.filename().string()), toml_text(root));
}

std::string fitted_leak_table_text(const Campaign& campaign, const LeakTableSettings& settings,
                                   const fs::path& out_dir) {
  toml::table root = parse_toml_file(campaign.file);
  write_changed_values(root, campaign);
  toml::table& assumptions = child(child(root, "leak_table", false), "assumptions", false);
  for (const Assumption& assumption : settings.assumptions) {
    const model::ParameterSpec& spec = assumption_spec(campaign.rig.plant, assumption.index);
    toml::table& entry = child(assumptions, spec.key, true);
    put(entry, spec, "value", assumption.value);
    entry.insert_or_assign("source", assumption.source);
    if (!assumption.fit) continue;
    entry.insert_or_assign("fit", true);
    put(entry, spec, "start", assumption.start);
    put(entry, spec, "lower", assumption.lower);
    put(entry, spec, "upper", assumption.upper);
  }
  rebase_records(root, resolved(campaign.data_dir),
                 out_dir.empty() ? fs::path() : resolved(out_dir));
  return fmt::format(
      "# Written by rigcal fit-tables from {}: the estimated values are in\n"
      "# [leak_table.assumptions]. Record paths start at the folder of this file.\n\n{}",
      toml_quoted(campaign.file.filename().string()), toml_text(root));
}

}  // namespace rigcal::datasets
