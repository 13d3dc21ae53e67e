#include "datasets/draft/draft_campaign.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <optional>

#include "common/error.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/draft/channels_text.hpp"
#include "datasets/draft/column_guess.hpp"
#include "datasets/draft/draft_comment.hpp"
#include "datasets/draft/file_columns.hpp"
#include "datasets/draft/rig_text.hpp"
#include "datasets/draft/start_motion.hpp"
#include "datasets/prepare/recognised_drive.hpp"
#include "datasets/prepare/waveform_guess.hpp"
#include "datasets/read/record_reader.hpp"
#include "model/plant/parameter.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

// ---- Text ----------------------------------------------------------------------------------

std::string relative_text(const fs::path& file, const fs::path& folder) {
  const fs::path absolute = fs::weakly_canonical(fs::absolute(file));
  const fs::path relative = absolute.lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
  return toml_quoted((relative.empty() ? absolute : relative).generic_string());
}

std::string numbers_text(const std::vector<std::string>& numbers) {
  bool consecutive = true;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool same_width = numbers[i].size() == numbers[0].size();
    consecutive = consecutive && same_width && numbers[0].size() < 9 &&
                  std::stol(numbers[i]) == std::stol(numbers[0]) + static_cast<long>(i);
  }
  if (consecutive) return toml_quoted(numbers.front() + ".." + numbers.back());
  std::vector<std::string> quoted;
  for (const std::string& number : numbers) quoted.push_back(toml_quoted(number));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// A file and its columns.
struct Recording {
  fs::path file;
  FileColumns columns;
};

/// Files of one condition, whose names differ only in their last number.
struct FileGroup {
  std::string id;
  std::vector<Recording> files;
};

std::string repeats_text(const std::vector<Recording>& files, const FileColumns& columns,
                         const fs::path& folder) {
  std::vector<std::string> entries;
  for (const auto& [file, own] : files) {
    const auto sets = column_sets(columns);
    if (sets.empty()) entries.push_back(relative_text(file, folder));
    for (const auto& set : sets) {
      std::vector<std::string> named;
      for (const ChannelColumns& column : set)
        named.push_back(
            fmt::format("{} = {}", info(column.channel).key, toml_quoted(column.stem + "{n}")));
      entries.push_back(fmt::format("{{ file = {}, n = {}, columns = {{ {} }} }}",
                                    relative_text(file, folder), numbers_text(set.front().numbers),
                                    fmt::join(named, ", ")));
    }
  }
  return fmt::format("repeats = [ {} ]\n", fmt::join(entries, ",\n            "));
}

// ---- Conditions ----------------------------------------------------------------------------

std::string id_of(const std::string& stem) {
  std::string id;
  for (const char c : stem) {
    const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    id += allowed ? c : '_';
  }
  while (!id.empty() && (id.back() == '_' || id.back() == '-' || id.back() == '.')) id.pop_back();
  return id.empty() ? "record" : id;
}

/// Proposes limits, as comments, for the compared channels other than the motion.
std::string limits_of_others(const FileColumns& columns) {
  std::string text;
  for (const Channel channel : {Channel::load_pressure, Channel::pressure_a, Channel::pressure_b}) {
    if (column_of(columns, channel) == nullptr || motion_of(columns) == nullptr) continue;
    const auto key = info(channel).key;
    text += fmt::format(
        "# [acceptance.{0}]\n# rho2 = 0.95  # or, in [acceptance]: not_judged = [\"{0}\"]\n", key);
  }
  return text;
}

/// Describes the initial state of the runs. It is taken from the record unless a run begins in
/// motion.
std::string initial_text(const std::vector<FileGroup>& groups) {
  const double window_s = Campaign().initial_window_s;
  for (const FileGroup& group : groups) {
    const FileColumns& columns = group.files.front().columns;
    const ChannelColumns* motion = motion_of(columns);
    if (motion == nullptr) continue;
    std::optional<std::pair<std::vector<double>, std::vector<double>>> signal;
    try {
      signal = signal_of(group.files.front().file, columns, *motion);
    } catch (const InputError&) {
      // unreadable_rows() describes the error
    }
    if (!signal || !motion_at_start(signal->first, signal->second, window_s)) continue;
    return fmt::format(
        "initial = \"fit\"  # estimated: {} moves within its first {:g} s; \"record\": their mean, "
        "\"rest\": from zero\n",
        group.id, window_s);
  }
  return fmt::format(
      "initial = \"record\"  # the mean of the first {:g} s; \"rest\": from zero; \"fit\": "
      "estimate "
      "it\n",
      window_s);
}

/// Rounds a number to the digits that a draft shows.
double as_shown(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }

/// Returns the frequency of the generated drive that a draft states, if a recorded drive equals
/// that drive, which has neither offset nor phase. Any other drive is used as recorded: a loop
/// follows its reference, so an error of the reference would pass into the estimates.
std::optional<double> generated_frequency_hz(
    const std::pair<std::vector<double>, std::vector<double>>& recorded,
    const WaveformGuess& guess) {
  const auto& [time_s, values] = recorded;
  if (!is_periodic(guess.waveform) || !guess.amplitude || !guess.can_be_generated)
    return std::nullopt;
  const auto found = recognised_drive(time_s, values, {}, 0.0);
  const auto period_s = found ? found->signal.period_s() : std::nullopt;
  if (!period_s || !(*period_s > 0.0)) return std::nullopt;
  const double frequency_hz = as_shown(1.0 / *period_s);
  const double amplitude = as_shown(*guess.amplitude);
  const model::Signal signal = periodic_signal(guess.waveform, amplitude, frequency_hz);
  constexpr double kRounding = 1e-6;  // fraction of the amplitude
  const double most = found->tolerance + kRounding * amplitude;
  for (const double t : time_s)
    if (!(std::abs(found->signal.value(t) - signal.value(t)) <= most)) return std::nullopt;
  return frequency_hz;
}

std::string waveform_text(const fs::path& file, const FileColumns& columns) {
  const ChannelColumns* drive = drive_of(columns);
  if (drive == nullptr)
    return fmt::format(
        "waveform = \"{}\"{}\n", kBlank,
        comment("\"recorded\" if a column above is the drive; else sine or square, with frequency "
                "and amplitude"));
  const auto signal = signal_of(file, columns, *drive);
  if (!signal)
    return fmt::format(
        "waveform = \"recorded\"{}\n",
        comment(columns.time.empty() ? "its time is not known" : "its time has no unit of time"));
  const auto& [time_s, values] = *signal;
  const double rate_hz =
      time_s.size() < 2 ? 0.0
                        : static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
  const WaveformGuess guess = guess_waveform(time_s, values);
  const bool periodic =
      is_periodic(guess.waveform) && guess.frequency_hz.has_value() && guess.amplitude.has_value();
  // A drive in another unit is recognised when its channel has a gain.
  const bool has_unit = converts_to(drive->unit, info(drive->channel).unit);
  const auto generated_hz = has_unit ? generated_frequency_hz(*signal, guess) : std::nullopt;
  std::string text =
      fmt::format("# {}: {}; {} samples at {:.6g} Hz, {:.6g} s\n", info(drive->channel).key,
                  guess.description, time_s.size(), rate_hz, time_s.back() - time_s.front());
  text += fmt::format(
      "waveform = \"{}\"{}\n", to_string(generated_hz ? guess.waveform : Waveform::recorded),
      periodic && has_unit && !generated_hz
          ? comment("not simulated as generated: its samples show an offset, a phase, noise or "
                    "another shape")
          : "");
  if (guess.frequency_hz && guess.amplitude)
    text += fmt::format("frequency = \"{:.4g} Hz\"\n", generated_hz.value_or(*guess.frequency_hz));
  if (guess.frequency_hz && guess.amplitude && has_unit)
    text += fmt::format("amplitude = \"{:.4g} {}\"\n", *guess.amplitude, drive->unit);
  return text;
}

constexpr std::size_t kFewestOfARecording = 8;  // samples

/// Whether a file has columns of numbers, whatever they are called.
bool has_numbers(const fs::path& file) {
  constexpr std::size_t kMostTried = 40;
  std::vector<std::string> names;
  for (const RecordColumn& column : record_reader(file).columns(file))
    if (names.size() < kMostTried) names.push_back(column.name);
  const auto columns = columns_or_none(file, names);
  return std::count_if(columns.begin(), columns.end(), [](const auto& values) {
           return values.size() >= kFewestOfARecording;
         }) >= 2;
}

/// Separates recordings from other files. A file without a time or a channel, such as a summary
/// stored with the recordings, is listed in `left_out`. If no file has both, files with numbers
/// count as recordings.
/// @throws InputError  if no file is a recording
std::vector<Recording> recordings_among(const std::vector<fs::path>& files,
                                        std::vector<std::string>& left_out) {
  std::vector<Recording> all;
  std::vector<Recording> others;
  for (const fs::path& file : files) {
    Recording recording{file, file_columns(file)};
    (recording.columns.lacks.empty() ? all : others).push_back(std::move(recording));
  }
  const bool any = !all.empty();
  for (Recording& other : others) {
    if (!any && has_numbers(other.file)) {
      all.push_back(std::move(other));
    } else {
      left_out.push_back(
          fmt::format("{} ({})", other.file.filename().string(), other.columns.lacks));
    }
  }
  if (all.empty()) throw InputError({files.at(0).string()}, others.at(0).columns.lacks);
  return all;
}

/// Lists what keeps a campaign from reading the first file of each group, as comments.
std::string unreadable_text(const std::vector<FileGroup>& groups) {
  std::string text;
  for (const FileGroup& group : groups) {
    const auto& [file, columns] = group.files.front();
    const std::string rows = unreadable_rows(file, columns);
    if (rows.empty()) continue;
    text += "# " +
            in_comment(fmt::format("a campaign rejects {}: {}", file.filename().string(), rows)) +
            "\n";
  }
  return text.empty() ? text : text + "\n";
}

std::vector<FileGroup> groups_of(std::vector<Recording> recordings) {
  std::vector<std::pair<std::pair<fs::path, std::string>, FileGroup>> groups;
  for (Recording& recording : recordings) {
    const fs::path& file = recording.file;
    const std::string stem = split_number(file.stem().string()).stem;
    const std::pair key{file.parent_path(), stem + file.extension().string()};
    auto found = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& group) { return group.first == key; });
    if (found == groups.end()) found = groups.insert(groups.end(), {key, {id_of(stem), {}}});
    found->second.files.push_back(std::move(recording));
  }
  std::vector<FileGroup> result;
  std::vector<std::string> ids;
  for (auto& [key, group] : groups) {
    if (group.files.size() == 1) group.id = id_of(group.files[0].file.stem().string());
    const std::string own = group.id;
    for (int i = 2; std::find(ids.begin(), ids.end(), group.id) != ids.end(); ++i)
      group.id = fmt::format("{}-{}", own, i);
    ids.push_back(group.id);
    result.push_back(group);
  }
  return result;
}

/// Reads the data for a draft: the time and drive from the first file of each group. A file that
/// cannot be read, for example because the time restarts with each of several runs, is listed in
/// `left_out`, and the next file in its group is used.
/// @throws InputError  if no group remains; it is the error of the first file that cannot be read
std::vector<FileGroup> readable_among(std::vector<FileGroup> groups,
                                      std::vector<std::string>& left_out) {
  std::optional<InputError> first;
  const auto reads = [&](const Recording& recording) {
    const auto& [file, columns] = recording;
    if (!columns.lacks.empty()) return true;  // has_numbers() has already read it
    const ChannelColumns* drive = drive_of(columns);
    ChannelColumns any;
    if (drive != nullptr) {
      any = *drive;
    } else if (!columns.channels.empty()) {
      any = columns.channels.front();
    } else {
      any.stem = columns.rows.empty() ? columns.time : columns.rows.front();
    }
    try {
      signal_of(file, columns, any);
    } catch (const InputError& error) {
      if (!first) first = error;
      left_out.push_back(file.filename().string() +
                         std::string(error.what()).substr(error.where().file.size()));
      return false;
    }
    return true;
  };
  for (FileGroup& group : groups)
    while (!group.files.empty() && !reads(group.files.front()))
      group.files.erase(group.files.begin());
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                              [](const FileGroup& group) { return group.files.empty(); }),
               groups.end());
  if (groups.empty()) throw *first;
  return groups;
}

}  // namespace

Draft draft_campaign(const std::vector<fs::path>& files, const fs::path& folder) {
  std::vector<std::string> left_out;
  auto groups = readable_among(groups_of(recordings_among(files, left_out)), left_out);
  for (FileGroup& group : groups)
    for (Recording& recording : group.files) set_sparse_aside(recording.file, recording.columns);
  const auto& [first, columns] = groups.at(0).files.at(0);
  // The unnamed rows may include a reference, so a position loop is assumed.
  auto loop = loop_of(columns);
  if (!loop && !columns.rows.empty()) loop = model::Feedback::position;
  const bool chambers = std::any_of(groups.begin(), groups.end(), [](const FileGroup& group) {
    const FileColumns& own = group.files.front().columns;
    return column_of(own, Channel::pressure_a) != nullptr ||
           column_of(own, Channel::pressure_b) != nullptr;
  });
  std::string text = fmt::format(
      "#:schema ./{}\n"
      "# Draft by rigcal init. Replace every \"{}\", delete what does not apply, then run\n"
      "# rigcal check on this file. docs/campaign-file.md explains every key.\n"
      "schema = \"rigcal.campaign/1\"\nname = \"New rig\"\n\n",
      kSchemaFile, kBlank);
  for (const std::string& file : left_out)
    text += fmt::format("# left out: {}\n", in_comment(file));
  if (!left_out.empty()) text += "\n";
  const std::string unreadable = unreadable_text(groups);
  text += unreadable;
  auto plant = chambers || has_pilot(columns) ? model::PlantKind::two_chamber
                                              : model::PlantKind::load_pressure;
  if (turns(columns)) plant = model::PlantKind::linkage;
  const bool slides = plant != model::PlantKind::linkage;
  const auto recorded = [&own = columns](Channel channel) {
    return column_of(own, channel) != nullptr;
  };
  const bool both = recorded(Channel::pressure_a) && recorded(Channel::pressure_b);
  RecordedSigns signs;
  signs.payload = slides && recorded(Channel::acceleration);
  signs.position = recorded(Channel::position);
  signs.load_table = slides && signs.position && both;
  signs.pilot = has_pilot(columns);
  signs.temperature = recorded(Channel::temperature);
  signs.pressures = both || recorded(Channel::load_pressure);
  signs.supply = recorded(Channel::supply_pressure);
  signs.command = !loop && !signs.pilot && recorded(Channel::command);
  signs.spool =
      std::any_of(columns.unknown.begin(), columns.unknown.end(),
                  [](const UnknownColumn& column) { return column.other == kSpoolPosition; });
  text += rig_text(plant, loop, signs);
  text += "\n[recording]\n" + initial_text(groups);
  text += "# " + draft_line("recording", "before");
  text += "# " + draft_line("recording", "decimate_to");
  if (!unreadable.empty())
    text +=
        "# holes = \"bridge\"  # with longest_hole: ignores samples that are missing from a file\n";
  text += channels_text(first, columns);
  text += "\n[averaging]\n" + draft_line("averaging", "align") +
          "\n# [acceptance]  # what PASS means\n# rho2 = 0.99\n# absolute_error_percent = 1.0\n# " +
          draft_line("acceptance", "decision") + limits_of_others(columns);
  for (const FileGroup& group : groups) {
    const FileColumns& own = group.files.front().columns;
    text += fmt::format("\n[[condition]]\nid = {}\n", toml_quoted(group.id));
    text += waveform_text(group.files.front().file, own);
    text += draft_line("condition", "use") + "# " + draft_line("condition", "leak_level");
    text += repeats_text(group.files, own, folder);
  }
  return {text, left_out};
}

}  // namespace rigcal::datasets
