#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/checks/short_records.hpp"
#include "python/arrays.hpp"
#include "python/campaign.hpp"
#include "python/described_members.hpp"
#include "python/result.hpp"
#include "report/job/job.hpp"
#include "report/run/check.hpp"
#include "report/store/folder.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using datasets::Record;
using RecordPtr = std::shared_ptr<Record>;

/// A channel of a record. It keeps the record alive.
struct RecordedChannel {
  std::shared_ptr<const datasets::Series> series;
  datasets::ChannelInfo about;
};

/// Findings of `check`.
struct Checked {
  std::vector<RecordPtr> records;
  std::vector<std::string> without_record;
  std::string text;
};

Dict<std::string, RecordedChannel> channels_of(const RecordPtr& record) {
  Dict<std::string, RecordedChannel> channels;
  for (const auto& [channel, series] : record->channels) {
    const datasets::ChannelInfo& about = info(channel);
    channels[py::str(about.key.data(), about.key.size())] =
        RecordedChannel{std::shared_ptr<const datasets::Series>(record, &series), about};
  }
  return channels;
}

Dict<std::string, RecordPtr> average(const Campaign& self, const std::optional<fs::path>& out,
                                     bool force) {
  require_path("out", out);
  std::vector<Record> records;
  const std::string call =
      self.call + ".average(" + (out ? written("out", decoded(out->string())) : "") + ")";
  const int threads = thread_count(std::nullopt);
  {
    const py::gil_scoped_release released;
    std::optional<report::HeldFolder> held;
    const std::atomic<bool> cancel{false};
    report::JobTerms terms{call, report::recorded(self.choice), threads, cancel};
    terms.hold = [&](report::PlannedFiles planned) {
      if (!out) return;
      held.emplace(*out, holding("average", force));
      held->plan(std::move(planned));
    };
    records = report::averaged_records(self.campaign, terms);
    if (held) report::write_job(*held, threads, report::average_job(self.campaign, records, terms));
  }
  Dict<std::string, RecordPtr> by_condition;
  for (Record& record : records) {
    const std::string id = record.condition;
    by_condition[py::str(id)] = std::make_shared<Record>(std::move(record));
  }
  return by_condition;
}

Checked check(const Campaign& self) {
  const py::gil_scoped_release released;
  Checked checked;
  checked.text = report::check(self.campaign, [&](Record record) {
                   checked.records.push_back(std::make_shared<Record>(std::move(record)));
                 }).text;
  std::vector<Record*> all;
  for (const RecordPtr& record : checked.records) all.push_back(record.get());
  datasets::warn_of_short_records(self.campaign, all);
  for (const datasets::Condition& condition : self.campaign.conditions) {
    if (!condition.has_record()) checked.without_record.push_back(condition.id);
  }
  return checked;
}

void bind_channel(py::module_& module) {
  py::class_<RecordedChannel>(module, "Channel", "Mean over the repeats of one channel; SI.")
      .def_property_readonly("key", field(&RecordedChannel::about, &datasets::ChannelInfo::key),
                             "Name in campaign and results: \"position\".")
      .def_property_readonly("unit", field(&RecordedChannel::about, &datasets::ChannelInfo::unit),
                             "SI unit of mean and sd: \"m\".")
      .def_property_readonly(
          "repeats", [](const RecordedChannel& self) { return self.series->repeats; },
          "Number of repeats with this channel.")
      .def_property_readonly(
          "mean", [](const RecordedChannel& self) { return view(self.series, self.series->mean); },
          "Shape (samples), in `unit`.")
      .def_property_readonly(
          "sd",
          [](const RecordedChannel& self) { return view_or_none(self.series, self.series->sd); },
          "Standard deviation over the repeats, shape (samples), in `unit`; NaN where only "
          "one\nrepeat has a sample, None for a single repeat.")
      .def_property_readonly(
          "count",
          [](const RecordedChannel& self) { return view_or_none(self.series, self.series->count); },
          "Number of repeats with each sample, shape (samples); None for a record that was "
          "already\naveraged.")
      .def_property_readonly(
          "pooled_sd",
          [](const RecordedChannel& self) { return none_if_nan(self.series->pooled_sd); },
          "Standard deviation of one repeat, over all samples, in `unit`; None if it is unknown "
          "(no\nrepeats, and not stated in the campaign).")
      .def_property_readonly(
          "sd_of_mean",
          [](const RecordedChannel& self) { return none_if_nan(self.series->sd_of_mean); },
          "Standard deviation of the mean, in `unit`, by which residuals are divided; None "
          "if\nunknown.")
      .def("__repr__", [](const RecordedChannel& self) {
        return fmt::format("<rigcal.Channel {} [{}], {} samples>", self.about.key, self.about.unit,
                           self.series->mean.size());
      });
}

void bind_repeat(py::module_& module) {
  using datasets::RepeatReport;
  py::class_<RepeatReport> repeat(module, "Repeat", struct_doc<RepeatReport>());
  repeat
      .def_property_readonly(
          "source", [](const RepeatReport& self) { return decoded(self.source); },
          member_doc<RepeatReport>("source"))
      .def_readonly("shifted_s", &RepeatReport::shifted_s, member_doc<RepeatReport>("shifted_s"))
      .def("__repr__",
           [](const RepeatReport& self) { return fmt::format("<rigcal.Repeat {}>", self.source); });
  bind_members(module, repeat);
}

void bind_record(py::module_& module) {
  py::class_<Record, RecordPtr>(
      module, "Record", "The averaged record of one condition; SI. Its arrays are read-only.")
      .def_readonly("condition", &Record::condition, "Id of the condition.")
      .def_readonly("repeats", &Record::repeats, "Number of repeats that were averaged.")
      .def_property_readonly(
          "time_s", [](const RecordPtr& self) { return view(self, self->time_s); },
          "Shape (samples), increasing [s].")
      .def_property_readonly("channels", &channels_of, "Channels by key: \"position\".")
      .def_readonly("repeat_reports", &Record::repeat_reports,
                    "Reports on the repeats, in the order of the files.")
      .def_property_readonly(
          "windows_s",
          [](const Record& self) {
            std::vector<std::pair<double, double>> windows;
            for (const datasets::TimeWindow& window : self.windows)
              windows.emplace_back(window.start_s, window.end_s);
            return windows;
          },
          "Start and end of each part that is used [s]; empty: the whole record.")
      .def_readonly("notes", &Record::notes, "Notes on the processing of the recordings.")
      .def_readonly("warnings", &Record::warnings, "In words: outliers, gaps, spikes, sensors.")
      .def_property_readonly(
          "files",
          [](const Record& self) {
            std::vector<fs::path> files;
            for (const FileState& file : self.files) files.emplace_back(file.path);
            return files;
          },
          "Every file that was read for this record.")
      .def("to_frame", of_notebook<Frame>("to_frame"),
           "Time, and mean, sd and count of each channel, as a pandas DataFrame; ImportError "
           "without\n"
           "pandas.")
      .def("plot", of_notebook<Figure>("plot"),
           "Mean of each channel over time, with its standard deviation as a band, by matplotlib.\n"
           "Returns the Figure.")
      .def("__repr__", [](const Record& self) {
        return fmt::format("<rigcal.Record {}: {} samples, {} repeats>", self.condition,
                           self.time_s.size(), self.repeats);
      });
}

}  // namespace

void bind_records(py::module_& module, CampaignClass& campaign) {
  bind_channel(module);
  bind_repeat(module);
  bind_record(module);
  py::class_<Checked>(module, "Check", "What check() found.")
      .def_readonly("records", &Checked::records, "Records in the order of the campaign.")
      .def_readonly("without_record", &Checked::without_record,
                    "Ids of conditions without a record.")
      .def_property_readonly(
          "warnings",
          [](const Checked& self) {
            std::map<std::string, std::vector<std::string>> warnings;
            for (const RecordPtr& record : self.records) {
              if (!record->warnings.empty()) warnings[record->condition] = record->warnings;
            }
            return warnings;
          },
          "Warnings by id of the condition; conditions without warnings are omitted.")
      .def("__str__", [](const Checked& self) { return self.text; })
      .def("__repr__", [](const Checked& self) {
        return fmt::format("<rigcal.Check: {} records>", self.records.size());
      });
  campaign.def("check", &check, R"(Reads every record, as `rigcal check`.

str() of what is returned is what the command prints.

Raises:
    InputError: a recording is wrong)");
  campaign.def("average", &average, py::kw_only(), py::arg("out") = py::none(),
               py::arg("force") = false,
               R"(Averages the repeats of every condition, as `rigcal average`.

Args:
    out: folder for averaged/<condition>.csv and repeatability.csv; None writes nothing
    force: replace files that rigcal did not write, or that were changed since

Returns:
    the records by the ids of their conditions, in the order of the campaign

Raises:
    InputError: a recording is wrong, or there is none
    UsageError: a file that rigcal did not write would be replaced
    WriteError: a file cannot be written)");
}

}  // namespace rigcal::python
