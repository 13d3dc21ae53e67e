#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/file.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"
#include "datasets/draft/draft_campaign.hpp"
#include "datasets/draft/recordings_in.hpp"
#include "python/campaign.hpp"
#include "python/fit_result.hpp"
#include "python/interruptible.hpp"
#include "python/progress.hpp"
#include "python/result.hpp"
#include "report/document/render_terminal.hpp"
#include "report/fmu/zip.hpp"
#include "report/job/export_choices.hpp"
#include "report/job/job.hpp"
#include "report/live/explore_page.hpp"
#include "report/page/page.hpp"
#include "report/text/escape.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using Levels = std::vector<std::string>;

// ---- functions that make results

/// Runs a job in a thread, so that Ctrl-C still works, and stores its files in a result.
ResultPtr job_result(const char* kind, std::string name, std::string call,
                     const report::CampaignChoice& choice, const std::optional<Integer>& threads,
                     const JobProgress& progress,
                     const std::function<report::JobResult(const report::JobTerms&)>& job) {
  std::atomic<bool> cancel{false};
  Progress reporter(progress, cancel);
  report::JobTerms terms{std::move(call), report::recorded(choice), thread_count(threads), cancel};
  terms.hold = [](const report::PlannedFiles&) {};
  terms.progress = [&](const char* pieces, int done, int all) {
    reporter.pieces(pieces, done, all);
  };
  auto result = std::make_shared<Result>();
  const auto raised = run_interruptibly(cancel, [&] {
    report::JobResult found = job(terms);
    result->kind = kind;
    result->name = std::move(name);
    result->files = std::move(found.files);
    for (const auto& document :
         report::result_documents(report::files_in(result->files), result->name))
      result->text += render_terminal(document, report::Style{});
    result->inputs = std::move(found.inputs);
  });
  if (raised) std::rethrow_exception(raised);
  reporter.rethrow();
  return result;
}

std::string path_text(const char* name, const fs::path& path) {
  return written(name, decoded(path.string()));
}

ResultPtr diagnose(const CampaignPtr& self, const std::optional<FitArgument>& fit,
                   const std::optional<fs::path>& table, const std::optional<Levels>& healthy,
                   const std::optional<Integer>& threads, const JobProgress& progress) {
  require_path("table", table);
  const report::DiagnosisRequest request{fit_source(fit, self->campaign.rig.plant),
                                         table.value_or(""), healthy.value_or(Levels{})};
  CallText call(self->call + ".diagnose");
  if (fit) call.add(written_fit(*fit));
  if (table) call.add(path_text("table", *table));
  call.add("healthy", healthy);
  return job_result("diagnosis", self->campaign.name, call.text(), self->choice, threads, progress,
                    [&](const report::JobTerms& terms) {
                      return report::diagnosis_job(self->campaign, request, terms);
                    });
}

ResultPtr parity(const CampaignPtr& self, const FitArgument& fit, double false_alarms,
                 const std::optional<Levels>& healthy, const std::optional<Integer>& threads,
                 const JobProgress& progress) {
  if (!(false_alarms > 0.0 && false_alarms < 0.5)) {
    throw py::value_error(fmt::format(
        "false_alarms: found {:g}, expected a probability above 0 and below 0.5", false_alarms));
  }
  const report::ParityRequest request{fit_source(fit, self->campaign.rig.plant),
                                      100.0 * false_alarms, healthy.value_or(Levels{})};
  CallText call(self->call + ".parity");
  call.add(written_fit(fit));
  call.add("false_alarms", std::optional(false_alarms));
  call.add("healthy", healthy);
  return job_result("parity", self->campaign.name, call.text(), self->choice, threads, progress,
                    [&](const report::JobTerms& terms) {
                      return report::parity_job(self->campaign, request, terms);
                    });
}

ResultPtr leak_table(const CampaignPtr& self, const std::optional<FitArgument>& fit,
                     const std::optional<std::vector<double>>& targets,
                     const std::optional<Levels>& signals, const std::optional<Integer>& threads) {
  for (const double target : targets.value_or(std::vector<double>{})) {
    if (!(target >= 1e-3 && target <= 1000.0))
      throw py::value_error(fmt::format(
          "targets: found {:g}, expected percentages of the servo flow from 0.001 to 1000",
          target));
  }
  const report::LeakTableRequest request{fit_source(fit, self->campaign.rig.plant),
                                         targets.value_or(std::vector<double>{}),
                                         signals.value_or(Levels{})};
  CallText call(self->call + ".leak_table");
  if (fit) call.add(written_fit(*fit));
  call.add("targets", targets);
  call.add("signals", signals);
  return job_result("leak_table", self->campaign.name, call.text(), self->choice, threads,
                    std::nullopt, [&](const report::JobTerms& terms) {
                      return report::leak_table_job(self->choice, request, terms);
                    });
}

ResultPtr plan(const CampaignPtr& self, const std::optional<FitArgument>& fit,
               const std::optional<std::vector<std::string>>& design,
               const std::optional<Integer>& threads, const JobProgress& progress) {
  const report::PlanRequest request{fit_source(fit, self->campaign.rig.plant),
                                    design.value_or(std::vector<std::string>{})};
  CallText call(self->call + ".plan");
  if (fit) call.add(written_fit(*fit));
  call.add("design", design);
  return job_result("plan", self->campaign.name, call.text(), self->choice, threads, progress,
                    [&](const report::JobTerms& terms) {
                      return report::plan_job(self->campaign, request, terms);
                    });
}

ResultPtr compare(const std::vector<fs::path>& folders) {
  CallText call("rigcal.compare");
  std::vector<py::str> names;
  names.reserve(folders.size());
  for (const fs::path& folder : folders) names.push_back(decoded(folder.string()));
  call.add("folders", std::optional(names));
  return job_result(
      "comparison", "", call.text(), {}, std::nullopt, std::nullopt,
      [&](const report::JobTerms& terms) { return report::comparison_job(folders, terms); });
}

ResultPtr batch(const fs::path& folder, const fs::path& out,
                const std::optional<std::vector<fs::path>>& earlier, bool diagnose, bool resume,
                bool force, const std::optional<fs::path>& root,
                const std::optional<Integer>& starts, const Integer& seed, const Integer& bootstrap,
                bool profiles, const std::optional<Integer>& posterior, bool cross_validate,
                std::optional<double> max_time_s, const std::optional<Integer>& max_evaluations,
                const std::optional<Integer>& threads, const JobProgress& progress) {
  require_path("folder", folder);
  require_path("out", out);
  require_path("root", root);
  report::BatchRequest request;
  request.folder = folder;
  request.root = root.value_or("");
  request.earlier = earlier.value_or(std::vector<fs::path>());
  request.choices = choices_of(starts, seed, bootstrap, profiles, posterior, cross_validate,
                               max_time_s, max_evaluations);
  request.resume = resume;
  request.diagnose = diagnose;
  request.force = force;
  CallText call("rigcal.batch");
  call.add(path_text("folder", folder));
  call.add(path_text("out", out));
  return job_result("batch", "", call.text(), {}, threads, progress,
                    [&](const report::JobTerms& given) {
                      report::JobTerms terms = given;
                      terms.out = out;
                      std::optional<report::HeldFolder> held;
                      terms.hold = [&](report::PlannedFiles planned) {
                        held.emplace(out, holding("batch", force));
                        held->plan(std::move(planned));
                      };
                      const report::RigVerbs verbs = report::verbs_in_process(request, terms);
                      report::JobResult found = report::batch_job(request, verbs, terms);
                      report::write_job(*held, terms.threads, found);
                      return found;
                    });
}

std::pair<fs::path, std::vector<std::string>> export_fmu(
    const CampaignPtr& self, const fs::path& out, const std::optional<FitArgument>& fit,
    const std::optional<std::string>& condition, const std::optional<std::string>& level,
    bool without_delay, bool force) {
  require_path("out", out);
  const report::ExportRequest request{fit_source(fit, self->campaign.rig.plant), condition, level,
                                      without_delay};
  const py::gil_scoped_release released;
  const report::ExportChoice choice = report::choose_export(self->campaign, self->choice, request);
  report::HeldFolder held(out, holding("export", force));
  const std::string name = choice.fmu.identifier + ".fmu";
  held.plan({{name}, {}});
  report::write_results(held, {{name, report::zipped(report::fmu_files(choice.fmu))}},
                        choice.inputs);
  return {out / name, choice.warnings};
}

std::pair<fs::path, std::vector<std::string>> init(const std::vector<fs::path>& files,
                                                   const fs::path& out, bool force) {
  require_path("out", out);
  if (files.empty()) throw py::value_error("files: found none, expected recordings or folders");
  const py::gil_scoped_release released;
  report::HeldFolder held(out, holding("init", force));
  held.plan({{"campaign.toml", datasets::kSchemaFile}, {}});
  const datasets::Draft draft = datasets::draft_campaign(datasets::recordings_in(files), out);
  report::write_results(
      held, {{"campaign.toml", draft.text}, {datasets::kSchemaFile, datasets::campaign_schema()}},
      {});
  return {out / "campaign.toml", draft.left_out};
}

// ---- members

std::vector<fs::path> write_files_of(const Result& self, const fs::path& out,
                                     const std::optional<Integer>& threads, bool force) {
  require_path("out", out);
  const int thread_number = thread_count(threads);
  const py::gil_scoped_release released;
  report::HeldFolder held(out, holding(self.kind, force));
  report::PlannedFiles planned;
  for (const report::ResultFile& file : self.files) planned.files.push_back(file.path);
  planned.files.emplace_back("report.html");
  held.plan(std::move(planned));
  std::vector<report::ResultFile> files = self.files;
  report::add_page(out, thread_number, files);
  report::write_results(held, files, self.inputs);
  std::vector<fs::path> paths;
  for (const report::ResultFile& file : files) paths.push_back(out / file.path);
  return paths;
}

JsonDict content_of(const Result& self) {
  return py::module_::import("json").attr("loads")(self.files.back().content);
}

std::string page_of(const Result& self) {
  const py::gil_scoped_release released;
  return report::result_page(report::files_in(self.files), self.name, 1);
}

Dict<std::string, std::string> files_of(const Result& self) {
  Dict<std::string, std::string> files;
  for (const report::ResultFile& file : self.files)
    files[py::str(file.path.generic_string())] = decoded(file.content);
  return files;
}

py::tuple state_of(const Result& self) {
  py::list files;
  for (const report::ResultFile& file : self.files)
    files.append(py::make_tuple(file.path.string(), py::bytes(file.content)));
  py::list inputs;
  for (const report::InputFile& input : self.inputs)
    inputs.append(py::make_tuple(py::bytes(input.path), input.sha256));
  return py::make_tuple(self.kind, self.name, self.text, files, inputs);
}

ResultPtr from_state(const py::tuple& state) {
  auto result = std::make_shared<Result>();
  result->kind = state[0].cast<std::string>();
  result->name = state[1].cast<std::string>();
  result->text = state[2].cast<std::string>();
  for (const auto& file : state[3].cast<std::vector<std::pair<std::string, std::string>>>())
    result->files.push_back({file.first, file.second});
  for (const auto& input : state[4].cast<std::vector<std::pair<std::string, std::string>>>())
    result->inputs.push_back({input.first, input.second});
  return result;
}

}  // namespace

Page explore_page_of(const datasets::Campaign& campaign,
                     const std::vector<datasets::FittedValue>& fitted, const std::string& command) {
  const std::vector<report::LiveCase> cases = report::live_cases(campaign, fitted);
  std::vector<datasets::Record> records;
  for (const report::LiveCase& each : cases)
    if (each.task.record) records.push_back(*each.task.record);
  return {report::explore_page(campaign, cases, command, report::hash_inputs(campaign, records))};
}

py::tuple reduced(const ResultPtr& result) {
  return py::make_tuple(notebook("restored"), py::make_tuple(state_of(*result)));
}

std::string frame_of(const std::string& page) {
  return "<iframe style=\"width: 100%; height: 36em; border: 1px solid #8884\" srcdoc=\"" +
         report::escaped(page) + "\"></iframe>";
}

report::FitSource fit_source(const std::optional<FitArgument>& fit, model::PlantKind plant) {
  if (!fit) return {};
  if (const auto* file = std::get_if<fs::path>(&*fit)) {
    require_path("fit", *file);
    return {*file};
  }
  const FitResult& result = *std::get<FitResultPtr>(*fit);
  const py::gil_scoped_release released;
  report::StoredFit stored = report::stored(result.result());
  report::as_read_back(stored);
  return {{},
          std::make_shared<const report::EarlierFit>(report::earlier_fit(stored, "fit", plant))};
}

std::string written_fit(const FitArgument& fit) {
  if (const auto* file = std::get_if<fs::path>(&fit)) return path_text("fit", *file);
  return std::get<FitResultPtr>(fit)->provenance.command;
}

void bind_results(py::module_& module) {
  py::class_<Result, ResultPtr>(
      module, "Result",
      "Result of a verb other than fit and validate: its files, in memory. It can be pickled.")
      .def_readonly("kind", &Result::kind,
                    "\"diagnosis\", \"parity\", \"leak_table\", \"plan\", \"comparison\" or "
                    "\"batch\"; \"fit\"\n"
                    "or \"validation\" of a Fit that was pickled.")
      .def("json", &content_of, "The contents of its JSON file, as a dict.")
      .def_property_readonly("files", &files_of,
                             "Text of each file that write() writes, by path; without the page.")
      .def_property_readonly("page", &page_of, "The page that write() writes, as HTML.")
      .def(
          "to_frame",
          [](const py::object& self, const std::optional<std::string>& table) {
            return Frame(notebook("to_frame")(self, table));
          },
          py::arg("table") = py::none(),
          R"(A table of the result as a pandas DataFrame; ImportError without pandas.

Args:
    table: a list of the JSON, such as "states" of a diagnosis; None: the rows of most interest

Raises:
    KeyError: there is no such table)")
      .def("plot", of_notebook<Figure>("plot"),
           "Plots the main values with their intervals by matplotlib. Returns the Figure.")
      .def("write", &write_files_of, py::arg("out"), py::kw_only(), py::arg("threads") = py::none(),
           py::arg("force") = false,
           R"(Writes the files of the command, report.html among them.

Args:
    out: folder, made where it is missing
    threads: that draw the page; None: as many as the machine has
    force: replace files that rigcal did not write, or that were changed since

Returns:
    what was written, the JSON last

Raises:
    WriteError: a file cannot be written
    UsageError: a file would replace one that the result was made from, or one that rigcal did not
        write; or another run writes there)")
      .def("_repr_html_",
           [](const Result& self) {
             return frame_of(report::brief_page(report::files_in(self.files), self.name));
           })
      .def("__str__", [](const Result& self) { return decoded(self.text); })
      .def("__repr__",
           [](const Result& self) {
             return "<rigcal.Result: " + self.kind +
                    (self.name.empty() ? ">" : " of \"" + self.name + "\">");
           })
      .def_static("_restored", &from_state)
      .def("__reduce__", &reduced);
  py::class_<Page>(module, "Page", "An HTML page, which a notebook shows in a frame.")
      .def_readonly("html", &Page::html, "The whole page.")
      .def(
          "write",
          [](const Page& self, const fs::path& path) {
            require_path("path", path);
            write_file_atomically(path, self.html);
            return path;
          },
          py::arg("path"), "Writes the page. Returns the path.")
      .def("__repr__", [](const Page&) { return "<rigcal.Page>"; })
      .def("_repr_html_", [](const Page& self) { return frame_of(self.html); });
}

void bind_verbs(py::module_& module, CampaignClass& campaign) {
  campaign.def("diagnose", &diagnose, py::arg("fit") = py::none(), py::kw_only(),
               py::arg("table") = py::none(), py::arg("healthy") = py::none(),
               py::arg("threads") = py::none(), py::arg("progress") = py::none(),
               R"(Searches the leak of every record, as `rigcal diagnose`.

Args:
    fit: a Fit to healthy records, or the path of its fit.json
    table: leak_table.json of the same rig, whose rows are the limits of the classes
    healthy: leak levels that are healthy, besides those that the campaign knows
    threads: None: as many as the machine has; results do not depend on it
    progress: called with Pieces, from any thread; an exception there is raised here

Raises:
    InputError: a recording, fit or table is wrong
    UsageError: there is no fit, or no such leak level)");
  campaign.def("parity", &parity, py::arg("fit"), py::kw_only(), py::arg("false_alarms") = 0.01,
               py::arg("healthy") = py::none(), py::arg("threads") = py::none(),
               py::arg("progress") = py::none(),
               R"(Residuals of every record against the healthy rig, as `rigcal parity`.

Args:
    fit: a Fit to healthy records, or the path of its fit.json
    false_alarms: probability that a healthy record raises an alarm
    healthy: leak levels that are healthy, besides those that the campaign knows
    threads, progress: as those of diagnose()

Raises:
    InputError: a recording or fit is wrong
    UsageError: there is no such leak level
    ValueError: false_alarms is out of its range)");
  campaign.def("leak_table", &leak_table, py::arg("fit") = py::none(), py::kw_only(),
               py::arg("targets") = py::none(), py::arg("signals") = py::none(),
               py::arg("threads") = py::none(),
               R"(Leakage coefficients for shares of the servo flow, as `rigcal leak-table`.

Args:
    fit: a Fit of the rig, or the path of its fit.json; None: the campaign's values and assumptions
    targets: shares in percent; None: the campaign's
    signals: drives such as "sine@0.1Hz@20mm"; None: the campaign's
    threads: None: as many as the machine has; results do not depend on it

Raises:
    InputError: the campaign or fit is wrong
    UsageError: a signal is unknown
    ValueError: a target is out of its range)");
  campaign.def("plan", &plan, py::arg("fit") = py::none(), py::kw_only(),
               py::arg("design") = py::none(), py::arg("threads") = py::none(),
               py::arg("progress") = py::none(),
               R"(What the records of the campaign will determine, as `rigcal plan`.

Args:
    fit: a Fit, or the path of a fit.json, whose values are taken; None: the campaign's own
    design: parameters that a test is designed for, within the limits of [design]
    threads, progress: as those of diagnose()

Raises:
    InputError: the campaign or fit is wrong)");
  campaign.def(
      "explore",
      [](const CampaignPtr& self) {
        const py::gil_scoped_release released;
        return explore_page_of(self->campaign, {}, self->call + ".explore()");
      },
      R"(The page of `rigcal explore`, which simulates the rig with the campaign's values.

Raises:
    InputError: no condition can be simulated
    UsageError: this module was built without the WebAssembly tools)");
  campaign.def("export_fmu", &export_fmu, py::arg("out"), py::kw_only(),
               py::arg("fit") = py::none(), py::arg("condition") = py::none(),
               py::arg("level") = py::none(), py::arg("without_delay") = false,
               py::arg("force") = false,
               R"(Writes the rig as an FMU (FMI 2.0), as `rigcal export fmu`.

Args:
    out: folder
    fit: a Fit, or the path of its fit.json; None: the campaign's own values
    condition: leak level, start and duration as in this condition
    level: leak level whose values are exported; None: the only one
    without_delay: leave transport_delay out, which an FMU cannot have
    force: replace files that rigcal did not write, or that were changed since

Returns:
    the path of the FMU, and warnings in words

Raises:
    InputError: a value is missing, or the rig has a term that an FMU cannot have
    UsageError: the leak level is not determined)");
  module.def(
      "compare", &compare, py::arg("folders"),
      R"(Compares results in folders, as `rigcal compare`; the first is what the others are compared with.

Raises:
    InputError: a folder has no result
    UsageError: there are fewer than two folders, or one is given twice)");
  module.def("batch", &batch, py::arg("folder"), py::arg("out"), py::kw_only(),
             py::arg("earlier") = py::none(), py::arg("diagnose") = false,
             py::arg("resume") = false, py::arg("force") = false, py::arg("root") = py::none(),
             py::arg("starts") = py::none(), py::arg("seed") = 1, py::arg("bootstrap") = 0,
             py::arg("profiles") = false, py::arg("posterior") = py::none(),
             py::arg("cross_validate") = false, py::arg("max_time") = py::none(),
             py::arg("max_evaluations") = py::none(), py::arg("threads") = py::none(),
             py::arg("progress") = py::none(),
             R"(Fits every rig beneath a folder, one after the other, as `rigcal batch`.

The results of each rig are written into a folder of its own in `out`, and a row for each rig.

Args:
    folder: every campaign.toml beneath it is a rig
    out: folder of the results
    earlier: `out` of earlier batches, for the trends
    diagnose: whether to diagnose the records of each rig by its fit
    resume: keep whole results of the same inputs and options; go on where a fit was stopped
    force: replace files that rigcal did not write, or that were changed since
    root: no file outside this folder is read; None: no limit
    starts, seed, bootstrap, profiles, posterior, cross_validate, max_time, max_evaluations: as
        those of Campaign.fit()
    threads: None: as many as the machine has; results do not depend on it
    progress: called with Pieces when a rig has ended; an exception there is raised here

Raises:
    UsageError: there is no campaign.toml, or `out` is one of `earlier`
    ValueError: an argument is out of its range)");
  module.def("init", &init, py::arg("files"), py::arg("out"), py::kw_only(),
             py::arg("force") = false,
             R"(Drafts a campaign file from recordings, as `rigcal init`.

Args:
    files: recordings, or folders of them
    out: folder of the draft
    force: replace a file that rigcal did not write, or that was changed since

Returns:
    the path of campaign.toml, and the files that it leaves out, with the reason

Raises:
    InputError: no recording can be read
    UsageError: a folder has no recordings)");
}

}  // namespace rigcal::python
