#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "common/suggest.hpp"
#include "python/arrays.hpp"
#include "python/described_members.hpp"
#include "python/fit_result.hpp"
#include "python/interruptible.hpp"
#include "python/progress.hpp"
#include "python/result.hpp"
#include "report/document/render_terminal.hpp"
#include "report/run/fit_choices.hpp"
#include "report/run/write_result.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// ---- functions that make fits

/// Raises the exception of the signal handler. Ctrl-C becomes an exception that contains the best
/// fit so far.
[[noreturn]] void raise_interrupted(const std::exception_ptr& raised, const FitResultPtr& found) {
  try {
    std::rethrow_exception(raised);
  } catch (const py::error_already_set& error) {
    if (!found || !error.matches(PyExc_KeyboardInterrupt)) throw;
    const py::object type = py::module_::import("rigcal.errors").attr("Interrupted");
    const py::object value = type(found->fit.message, found);
    value.attr("__cause__") = error.value();
    PyErr_SetObject(type.ptr(), value.ptr());
    throw py::error_already_set();
  }
}

/// Runs a job that makes a fit, and reports progress to `progress`.
FitResultPtr made(const CampaignPtr& self, const std::string& call,
                  const std::optional<Integer>& threads, const FitProgress& progress,
                  const std::function<report::JobResult(std::shared_ptr<const datasets::Campaign>,
                                                        const report::JobTerms&)>& job) {
  std::atomic<bool> cancel{false};
  Progress reporter(progress, cancel);
  report::JobTerms terms{call, report::recorded(self->choice), thread_count(threads), cancel};
  terms.hold = [](const report::PlannedFiles&) {};
  terms.watch = [&](calib::FitOptions& settings, const std::string&) { reporter.attach(settings); };
  FitResultPtr found;
  const auto raised = run_interruptibly(cancel, [&] {
    const std::shared_ptr<const datasets::Campaign> campaign(self, &self->campaign);
    found = std::make_shared<FitResult>(FitResult{std::move(*job(campaign, terms).fit), self});
  });
  if (raised) raise_interrupted(raised, found);
  reporter.rethrow();
  return found;
}

std::string call_of(const Campaign& campaign, const report::FitChoices& choices) {
  const report::FitChoices none;
  CallText call(campaign.call + ".fit");
  call.add("starts", choices.starts, none.starts);
  call.add("seed", choices.seed, none.seed);
  call.add("bootstrap", choices.bootstrap, none.bootstrap);
  call.add("profiles", choices.profiles, none.profiles);
  call.add("posterior", choices.posterior, none.posterior);
  call.add("cross_validate", choices.cross_validate, none.cross_validate);
  call.add("max_time", choices.max_time_s, none.max_time_s);
  call.add("max_evaluations", choices.max_evaluations, none.max_evaluations);
  return call.text();
}

/// Returns a copy of the posterior draws that NumPy owns.
std::optional<py::array_t<double>> draws_of(const FitResult& self) {
  if (!self.fit.posterior || self.fit.posterior->draws == 0) return std::nullopt;
  const calib::Posterior& found = *self.fit.posterior;
  py::array_t<double> draws({found.chains, found.draws, static_cast<int>(found.names.size())});
  auto entries = draws.mutable_unchecked<3>();
  for (py::ssize_t c = 0; c < entries.shape(0); ++c) {
    for (py::ssize_t i = 0; i < entries.shape(1); ++i) {
      for (py::ssize_t j = 0; j < entries.shape(2); ++j) {
        entries(c, i, j) = found.values[static_cast<std::size_t>(j)]
                                       [static_cast<std::size_t>(c * entries.shape(1) + i)];
      }
    }
  }
  draws.attr("flags").attr("writeable") = false;
  return draws;
}

FitResultPtr fit(const CampaignPtr& self, const std::optional<Integer>& starts, const Integer& seed,
                 const Integer& bootstrap, bool profiles, const std::optional<Integer>& posterior,
                 bool cross_validate, std::optional<double> max_time_s,
                 const std::optional<Integer>& max_evaluations,
                 const std::optional<Integer>& threads, const FitProgress& progress) {
  const report::FitChoices choices = choices_of(starts, seed, bootstrap, profiles, posterior,
                                                cross_validate, max_time_s, max_evaluations);
  return made(
      self, call_of(*self, choices), threads, progress,
      [&](std::shared_ptr<const datasets::Campaign> campaign, const report::JobTerms& terms) {
        return report::fit_job(std::move(campaign), {choices}, terms);
      });
}

FitResultPtr validate(const CampaignPtr& self, const std::optional<FitArgument>& fit,
                      const std::optional<Integer>& threads, const FitProgress& progress) {
  const report::ValidationRequest request{fit_source(fit, self->campaign.rig.plant)};
  const std::string call = self->call + ".validate(" + (fit ? written_fit(*fit) : "") + ")";
  return made(
      self, call, threads, progress,
      [&](std::shared_ptr<const datasets::Campaign> campaign, const report::JobTerms& terms) {
        return report::validation_job(std::move(campaign), request, terms);
      });
}

std::string text_of(const FitResult& self) {
  return render_terminal(report::document_of(self.result()), report::Style{});
}

ResultPtr result_of(const FitResult& self, int threads) {
  auto result = std::make_shared<Result>();
  result->kind = self.kind == report::ResultKind::fit ? "fit" : "validation";
  result->name = self.campaign->name;
  result->files = report::result_files(self.result(), threads);
  result->text = text_of(self);
  result->inputs = self.provenance.inputs;
  return result;
}

// ---- members

calib::FittedParameter parameter_of(const FitResult& self, const std::string& key,
                                    const std::optional<std::string>& level) {
  std::vector<std::string> known;
  std::vector<std::string> levels;
  for (const calib::FittedParameter& each : self.fit.parameters) {
    if (each.key != key && each.name != key) {
      known.push_back(each.key);
      continue;
    }
    if (each.level == level) return each;
    levels.push_back(each.level.value_or("None"));
  }
  if (levels.empty()) throw py::key_error(unknown_name_message("parameter", key, known));
  throw py::key_error(fmt::format("{}: found level {}, expected one of {}", key,
                                  level.value_or("None"), fmt::join(levels, ", ")));
}

Dict<std::string, ScoredCondition> scored_conditions(const FitResultPtr& self) {
  Dict<std::string, ScoredCondition> conditions;
  for (const calib::ConditionScore& score : self->fit.conditions) {
    conditions[py::str(score.id)] =
        ScoredCondition{std::shared_ptr<const calib::ConditionScore>(self, &score)};
  }
  return conditions;
}

std::vector<fs::path> write(const FitResult& self, const fs::path& out,
                            const std::optional<Integer>& threads, bool force) {
  require_path("out", out);
  const int thread_number = thread_count(threads);
  const py::gil_scoped_release released;
  const report::Result result = self.result();
  report::HeldFolder held(
      out, holding(result.kind == report::ResultKind::fit ? "fit" : "validate", force));
  std::vector<fs::path> paths;
  for (const fs::path& file : report::write_result(held, thread_number, result).files)
    paths.push_back(out / file);
  return paths;
}

JsonDict json_of_result(const FitResult& self) {
  std::string text;
  {
    const py::gil_scoped_release released;
    text = report::json_text(report::json_of(report::stored(self.result())));
  }
  return py::module_::import("json").attr("loads")(text);
}

/// Returns None if nothing has been estimated yet, because zero would look like a perfect fit.
std::optional<double> cost_of(const FitResult& self) {
  const bool has_cost =
      report::status_of(self.fit) != calib::FitStatus::failed && !self.fit.starts.empty();
  return has_cost ? std::optional(self.fit.cost) : std::nullopt;
}

Page explore(const FitResult& self) {
  std::vector<datasets::FittedValue> values;
  for (const calib::FittedParameter& p : self.fit.parameters)
    if (p.fitted && !p.nuisance)
      values.push_back({p.index, p.scope, p.level.value_or(""), p.value});
  const py::gil_scoped_release released;
  return explore_page_of(*self.campaign, values, self.provenance.command + ".explore()");
}

void bind_start(py::module_& module) {
  using calib::StartReport;
  py::class_<StartReport> start(module, "Start", struct_doc<StartReport>());
  bind_members(module, start);
}

void bind_result(py::module_& module) {
  using calib::Fit;
  using Self = FitResult;
  py::class_<Self, FitResultPtr> target(
      module, "Fit",
      "Result of a fit or of a validation (kind \"validation\"); SI. Its arrays are "
      "read-only.\nFurther values are in json(), as described in docs/command-line.md.");
  const auto add = [&](const char* name, auto member) {
    target.def_property_readonly(
        name, [member](const Self& self) { return self.fit.*member; }, member_doc<Fit>(name));
  };
  add("message", &Fit::message);
  add("verdict", &Fit::verdict);
  add("assessment", &Fit::assessment);
  add("warnings", &Fit::warnings);
  add("residual_count", &Fit::residual_count);
  add("evaluations", &Fit::evaluations);
  add("wall_seconds", &Fit::wall_seconds);
  target
      .def_property_readonly(
          "kind",
          [](const Self& self) {
            return Typed<"Literal['fit', 'validation']">(
                self.kind == report::ResultKind::fit ? "fit" : "validation");
          },
          "\"fit\" or \"validation\".")
      .def_property_readonly(
          "campaign", [](const Self& self) { return self.source; }, "The campaign that was fitted.")
      .def_property_readonly(
          "status", [](const Self& self) { return report::status_of(self.fit); },
          "\"converged\", \"stopped\" (the best so far) or \"failed\".")
      .def("parameter", &parameter_of, py::arg("key"), py::arg("level") = py::none(),
           R"(One parameter.

Args:
    key: "bulk_modulus", or its name with unit, "bulk_modulus_pa"
    level: leak level or condition; None: that of the rig

Raises:
    KeyError: there is none)")
      .def_property_readonly(
          "conditions", &scored_conditions,
          "Conditions with use \"fit\" or \"validate\" by id, in the order of the campaign.")
      .def_property_readonly("cost", &cost_of,
                             "Half the sum of squared weighted residuals, priors included; "
                             "None\nif nothing was estimated.")
      .def_property_readonly(
          "simulation_tolerance", [](const Self& self) { return self.fit.tolerance; },
          "Local error per step of the simulations, relative to the peak of each state.")
      .def_property_readonly(
          "correlation_names", [](const Self& self) { return self.fit.correlation.names; },
          "Names of the rows and columns of `correlation`.")
      .def_property_readonly(
          "correlation", [](const Self& self) { return array_of(self.fit.correlation.matrix); },
          "Correlations of the estimates that have a standard error, shape (names, names).")
      .def_property_readonly(
          "singular_values",
          [](const FitResultPtr& self) { return view(self, self->fit.singular_values); },
          "Singular values of the scaled Jacobian at the optimum, shape (unknowns).")
      .def_property_readonly(
          "bootstrap_replicates",
          [](const Self& self) { return self.fit.bootstrap ? self.fit.bootstrap->replicates : 0; },
          "Number of bootstrap replicates that converged.")
      .def_property_readonly("draws", &draws_of,
                             "Draws from the posterior, SI, shape (chains, draws, unknowns); None "
                             "without a posterior.")
      .def_property_readonly(
          "draw_names",
          [](const Self& self) {
            return self.fit.posterior ? self.fit.posterior->names : std::vector<std::string>();
          },
          "Names of the unknowns in `draws`.")
      .def("json", &json_of_result,
           R"(Contents of the fit.json, or validation.json, that write() would write.

`provenance.files` is not among them: no files are written yet. Numbers are the same bits.)")
      .def("write", &write, py::arg("out"), py::kw_only(), py::arg("threads") = py::none(),
           py::arg("force") = false,
           R"(Writes the files of `rigcal fit`, or `rigcal validate`, report.html among them.

They are the same bytes as the command's, but for `wall_seconds` and `provenance.command`.

Args:
    out: folder, made where it is missing
    threads: that draw the page; None: as many as the machine has
    force: replace files that rigcal did not write, or that were changed since

Returns:
    what was written, fit.json (validation.json) last

Raises:
    WriteError: a file cannot be written
    UsageError: a file would replace one that the result was made from, or one that rigcal did not
        write; or another run writes there)")
      .def("explore", &explore,
           R"(The page of `rigcal explore`, which simulates the rig with these estimates.

Shown in a notebook; `write(path)` saves it.

Raises:
    UsageError: this module was built without the WebAssembly tools)")
      .def("to_frame", of_notebook<Frame>("to_frame"),
           "The parameters as a pandas DataFrame, one row each; ImportError without pandas.")
      .def(
          "plot",
          [](const py::object& self, const std::optional<std::string>& condition,
             const std::optional<std::string>& channel) {
            return Figure(notebook("plot")(self, condition, channel));
          },
          py::arg("condition") = py::none(), py::arg("channel") = py::none(),
          R"(Measurement, model and residual of a condition, by matplotlib.

Args:
    condition: its id; None: the one with the largest error
    channel: its key; None: the first that was compared

Returns:
    the Figure)")
      .def("_repr_html_",
           [](const Self& self) { return frame_of(report::brief_page(self.result())); })
      .def("__reduce__",
           [](const Self& self) {
             ResultPtr result;
             {
               const py::gil_scoped_release released;
               result = result_of(self, thread_count(std::nullopt));
             }
             return reduced(result);
           })
      .def("__str__", &text_of, "The output of the command.")
      .def("__repr__", [](const Self& self) {
        return fmt::format("<rigcal.Fit of \"{}\": {}, {}>", self.campaign->name,
                           to_string(report::status_of(self.fit)),
                           self.fit.verdict ? to_string(*self.fit.verdict) : "no verdict");
      });
  bind_members_of<calib::Findings>(
      module, target, [](const Self& self) -> const calib::Findings& { return self.fit; });
  bind_members_of<calib::SearchOutcome>(
      module, target, [](const Self& self) -> const calib::SearchOutcome& { return self.fit; });
}

}  // namespace

void bind_fits(py::module_& module, CampaignClass& campaign) {
  bind_start(module);
  bind_result(module);
  campaign.def("fit", &fit, py::kw_only(), py::arg("starts") = py::none(), py::arg("seed") = 1,
               py::arg("bootstrap") = 0, py::arg("profiles") = false,
               py::arg("posterior") = py::none(), py::arg("cross_validate") = false,
               py::arg("max_time") = py::none(), py::arg("max_evaluations") = py::none(),
               py::arg("threads") = py::none(), py::arg("progress") = py::none(),
               R"(Estimates the free parameters and scores the conditions, as `rigcal fit`.

A fit that fails says so in its status; nothing is raised.

Args:
    starts: None: the campaign's number, or 1, and 3 more where that ends at no minimum
    seed: of the further starts, the bootstrap...
    bootstrap: number of replicates; 0: none
    profiles: whether to follow the profile likelihood of every parameter
    posterior: draws of each of four chains; None: the campaign's number, or none
    cross_validate: whether to leave out one condition after the other and predict it
    max_time: stops the fit, bootstrap and all [s]; None: the campaign's limit, or none
    max_evaluations: stops it after so many evaluations of all conditions
    threads: None: as many as the machine has; results do not depend on it
    progress: called with an Iteration or Pieces, from any thread; an exception there ends the
        fit and is raised here

Raises:
    InputError: a recording is wrong, no parameter is free...
    ValueError: an argument is out of its range
    Interrupted: Ctrl-C; it holds the best fit so far)");
  campaign.def("validate", &validate, py::arg("fit") = py::none(), py::kw_only(),
               py::arg("threads") = py::none(), py::arg("progress") = py::none(),
               R"(Scores the conditions with the values of an earlier fit, as `rigcal validate`.

Args:
    fit: a Fit, or the path of a fit.json, which then is among the inputs of the result; None: the
        campaign's own values
    threads: None: as many as the machine has; results do not depend on it
    progress: as that of fit()

Raises:
    InputError: a recording is wrong, or fit holds no values for this campaign
    Interrupted: Ctrl-C; it holds what was reached)");
}

}  // namespace rigcal::python
