#include "calib/design/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/design/criterion.hpp"
#include "calib/design/evolution.hpp"
#include "calib/design/trial_rig.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/problem/r_factor.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "calib/trust/planned_record.hpp"
#include "calib/trust/symmetry.hpp"
#include "common/parallel.hpp"
#include "common/suggest.hpp"
#include "datasets/campaign/design/drive_file.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::DriveFamily;
using datasets::Record;

/// Tolerance for comparing many drives, with which sensitivities are accurate to one percent.
constexpr double kTrialTolerance = 1e-5;
/// Tolerance for checking the drive that is written.
constexpr double kFineTolerance = 1e-8;
constexpr int kFiner = 4;  // number of response samples per drive sample
constexpr int kMostScalings = 6;
constexpr int kMostFineScalings = 20;
/// A drive that uses at least this fraction of a limit is not scaled up further.
constexpr double kUsed = 0.95;
constexpr double kAimedAt = 0.98;
constexpr double kFineAimedAt = 0.999;

bool is_set(const std::atomic<bool>* flag) { return flag != nullptr && flag->load(); }

// Functions that check the names of parameters.

[[noreturn]] void fail_known(const Campaign& campaign, const TrialRig& rig, int index,
                             const std::string& name) {
  const datasets::ParameterSetting* setting = campaign.setting(index);
  const std::string section =
      model::parameter_spec(campaign.rig.plant, index).kind == model::ParameterKind::controller
          ? "controller"
          : "parameters";
  if (setting != nullptr && setting->fit)
    throw InputError(rig.settings().where,
                     fmt::format("key 'design.like': --design names {0}, but \"{1}\" has a known "
                                 "value for it: expected a condition in which {0} is fitted",
                                 name, rig.settings().like.value_or("")));
  const std::string key = fmt::format("rig.{}.{}", section, name);
  throw InputError(setting != nullptr ? setting->where : Location{campaign.file.string()},
                   fmt::format("key '{}': --design names it, but it is not fitted: expected `fit = "
                               "true` with start and bounds, or --free {}",
                               key, name));
}

/// Returns the positions of the named parameters among the unknowns.
std::vector<std::size_t> named_unknowns(const Campaign& campaign, const TrialRig& rig,
                                        const std::vector<std::string>& names) {
  const auto& unknowns = rig.problem().map.unknowns();
  std::vector<std::string> fitted;
  for (const Unknown& unknown : unknowns)
    fitted.emplace_back(model::parameter_spec(campaign.rig.plant, unknown.index).key);
  std::set<std::size_t> found;
  for (const std::string& name : names) {
    const int index = model::parameter_index(campaign.rig.plant, name);
    if (index < 0) throw UsageError("--design: " + unknown_name_message("parameter", name, fitted));
    const auto at = std::find_if(unknowns.begin(), unknowns.end(),
                                 [&](const Unknown& unknown) { return unknown.index == index; });
    if (at == unknowns.end()) fail_known(campaign, rig, index, name);
    found.insert(static_cast<std::size_t>(at - unknowns.begin()));
  }
  if (found.empty()) throw UsageError("--design: expected the names of fitted parameters");
  return {found.begin(), found.end()};
}

// Functions that evaluate a single drive.

std::vector<double> drive_of(const TrialRig& rig, const DriveShape& shape, double scale) {
  std::vector<double> drive(shape.values.size());
  for (std::size_t i = 0; i < drive.size(); ++i)
    drive[i] = rig.neutral() + scale * rig.reach() * shape.values[i];
  return drive;
}

/// Returns the largest scale, up to 1, at which a drive keeps the limits, multiplied by the
/// fraction chosen for its shape. Returns std::nullopt if no such scale was found.
std::optional<double> allowed_scale(const TrialRig& rig, const DriveShape& shape) {
  double kept = 0.0;
  double broken = std::numeric_limits<double>::infinity();
  double scale = 1.0;
  for (int trial = 0; trial < kMostScalings; ++trial) {
    const auto uses = rig.uses_under(drive_of(rig, shape, scale), kTrialTolerance);
    const double share = uses ? largest_share(*uses) : std::numeric_limits<double>::infinity();
    (share <= 1.0 ? kept : broken) = scale;
    if (share <= 1.0 && (share >= kUsed || scale == 1.0)) break;
    double next = share > 0.0 && std::isfinite(share) ? scale * kAimedAt / share : 0.1 * scale;
    const double end = std::isfinite(broken) ? broken : 1.0;
    if (next <= kept || next >= broken) next = 0.5 * (kept + end);
    scale = std::min(next, 1.0);
  }
  if (kept == 0.0) return std::nullopt;
  return kept * shape.share;
}

struct Chosen {
  DriveFamily family = DriveFamily::multisine;
  Eigen::VectorXd point;
  double score = -std::numeric_limits<double>::infinity();
};

class Searcher {
 public:
  Searcher(const TrialRig& rig, const std::vector<std::size_t>& named, const DesignOptions& options)
      : rig_(rig), named_(named), options_(options), grid_(drive_grid(rig.settings())) {}

  const DriveGrid& grid() const { return grid_; }

  FamilyTrial search(DriveFamily family, Chosen& best) const {
    FamilyTrial trial;
    trial.family = family;
    auto stream =
        datasets::random_stream(rig_.settings().seed, {"design", datasets::to_string(family)});
    int tried = 0;
    const auto scores = [&](const std::vector<Eigen::VectorXd>& points) {
      std::vector<double> found(points.size());
      parallel_for(points.size(), options_.threads,
                   [&](std::size_t i) { found[i] = score(family, points[i]); });
      tried += static_cast<int>(points.size());
      if (options_.progress) options_.progress(family, tried, rig_.settings().evaluations);
      return found;
    };
    const Evolved evolved =
        maximise_in_box(drive_coordinates(family), rig_.settings().evaluations, stream, scores,
                        [&] { return is_set(options_.cancel); });
    trial.evaluations = evolved.evaluations;
    trial.found = evolved.point.size() > 0;
    if (!trial.found) return trial;
    const Eigen::MatrixXd rows = rows_of(family, evolved.point);
    if (rows.size() > 0) trial.sd = standard_deviations(rows);
    trial.sd.resize(rig_.z().size());
    if (evolved.score > best.score) best = {family, evolved.point, evolved.score};
    return trial;
  }

  std::vector<std::optional<double>> standard_deviations(const Eigen::MatrixXd& rows) const {
    const auto n = rows.cols();
    RFactor total(n);
    for (Eigen::Index begin = 0; begin < rows.rows(); begin += RFactor::kBlock)
      total.add(rows.middleRows(begin, std::min(RFactor::kBlock, rows.rows() - begin)));
    for (Eigen::Index j = 0; j < n; ++j) {
      Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, n);
      row(0, j) = rig_.problem().map.prior_slope(static_cast<int>(j),
                                                 rig_.z()[static_cast<std::size_t>(j)]);
      if (row(0, j) != 0.0) total.add(row);
    }
    return cramer_rao(rig_.problem(), rig_.z(), total.get());
  }

 private:
  Eigen::MatrixXd rows_of(DriveFamily family, const Eigen::VectorXd& point) const {
    const DriveShape shape = drive_shape(family, point, grid_);
    const auto scale = allowed_scale(rig_, shape);
    if (!scale) return {};
    return rig_.sensitivities(drive_of(rig_, shape, *scale), kTrialTolerance);
  }

  double score(DriveFamily family, const Eigen::VectorXd& point) const {
    const Eigen::MatrixXd rows = rows_of(family, point);
    if (rows.size() == 0) return -std::numeric_limits<double>::infinity();
    return design_score(rig_.problem(), rig_.z(), rows, named_, rig_.settings().criterion);
  }

  const TrialRig& rig_;
  const std::vector<std::size_t>& named_;
  const DesignOptions& options_;
  DriveGrid grid_;
};

/// Rounds the chosen drive as it will be written, and reduces it until a fine simulation keeps
/// every limit.
void check_finely(const TrialRig& rig, const datasets::DriveUnit& unit, const DriveShape& shape,
                  Design& design) {
  double scale = allowed_scale(rig, shape).value_or(0.0);
  for (int trial = 0; trial < kMostFineScalings && scale > 0.0; ++trial) {
    design.samples = drive_of(rig, shape, scale);
    for (double& value : design.samples) value = datasets::written_drive(unit, value);
    const auto uses = rig.uses_under(design.samples, kFineTolerance, kFiner, &design.response);
    const double share = uses ? largest_share(*uses) : std::numeric_limits<double>::infinity();
    if (share <= 1.0) {
      design.limits = *uses;
      design.amplitude = scale * rig.reach();
      return;
    }
    scale *= std::isfinite(share) ? kFineAimedAt / share : 0.5;
  }
  throw NoResultError(
      "design: none of the drives tried stays within the limits in a fine simulation");
}

// Functions for the comparison with the campaign's own signals.

bool is_comparable(const datasets::Condition& condition, const datasets::Condition* like) {
  if (!is_planned_with(condition)) return false;
  const datasets::Condition none;
  const datasets::Condition& of = like != nullptr ? *like : none;
  return condition.leak_level == of.leak_level && condition.overrides == of.overrides &&
         condition.specimen == of.specimen;
}

/// Adds the information that the campaign's own signals would provide in the duration of the test.
/// Each signal gets its fraction of that time, counted in samples, so that records with different
/// sample rates can be compared.
void add_own_signals(const Campaign& campaign, const std::vector<Record>& records,
                     const std::vector<datasets::FittedValue>* values, int threads,
                     Design& design) {
  const datasets::DesignSettings& settings = *campaign.design;
  const datasets::Condition* like = settings.like ? campaign.find(*settings.like) : nullptr;
  const auto sd_of_mean = [&](datasets::Channel channel) {
    const auto noise = design.noise_sd.find(channel);
    return noise == design.noise_sd.end() ? 1.0 : noise->second / std::sqrt(settings.repeats);
  };
  std::vector<const datasets::Condition*> conditions;
  std::vector<Record> own;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!is_comparable(condition, like)) continue;
    const auto record = std::find_if(records.begin(), records.end(), [&](const Record& each) {
      return each.condition == condition.id;
    });
    if (condition.has_record() && record == records.end()) continue;
    own.push_back(record != records.end() ? *record
                                          : planned_record(campaign, condition, sd_of_mean));
    for (auto& [channel, series] : own.back().channels)
      if (design.noise_sd.contains(channel)) series.sd_of_mean = sd_of_mean(channel);
    conditions.push_back(&condition);
  }
  if (conditions.empty()) return;
  const Problem problem = make_problem(campaign, own, conditions, false, nullptr);
  const std::vector<double> z = point_at(problem, values);
  const Evaluation at = evaluate_at(problem, z, threads);
  std::vector<double> weights(conditions.size(), 0.0);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    if (!at.conditions[i].ok()) continue;
    weights[i] = own[i].time_s.back() - own[i].time_s.front();
    design.own_signals_duration_s += weights[i];
    design.own_signals.push_back(conditions[i]->id);
  }
  if (!(design.own_signals_duration_s > 0.0)) return;
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] *=
        static_cast<double>(settings.samples()) /
        (design.own_signals_duration_s * static_cast<double>(problem.conditions[i].rows.size()));
  const auto sd = cramer_rao(problem, z, weighted_jacobian(problem, at, weights));
  for (DesignedParameter& designed : design.parameters) {
    for (std::size_t j = 0; j < sd.size(); ++j) {
      const TestedParameter same = parameter_at(problem, z, j);
      if (same.name == designed.name && same.level == designed.level)
        designed.sd_own_signals = sd[j];
    }
  }
}

/// Marks as undetermined those unknowns that only the smoothing of the orifice roots would
/// determine.
void leave_symmetric_open(const TrialRig& rig, int threads, Design& design) {
  const auto symmetry = scaling_symmetry(rig.problem(), rig.z(), 1.0, threads);
  if (!symmetry) return;
  const std::string words = describe(rig.problem(), *symmetry);
  if (!words.empty()) design.messages.push_back(words);
  if (!symmetry->holds()) return;
  for (const std::size_t j : symmetry->unknowns) design.parameters[j].sd.reset();
}

std::vector<DriveFamily> tried_families(const datasets::DesignSettings& settings) {
  if (settings.family) return {*settings.family};
  return enumerators_like(datasets::DriveFamily{});
}

}  // namespace

Design design(const Campaign& campaign, const std::vector<Record>& records,
              const std::vector<std::string>& names,
              const std::vector<datasets::FittedValue>* values, const DesignOptions& options) {
  if (!campaign.design)
    throw InputError({campaign.file.string()},
                     "--design needs a table [design]: expected its keys stroke, duration and "
                     "sample_rate");
  Design result;
  result.noise_sd = noise_of_one_repeat(campaign, records);
  TrialRig rig(campaign, result.noise_sd, values, options.cancel);
  const std::vector<std::size_t> named = named_unknowns(campaign, rig, names);
  const Searcher searcher(rig, named, options);
  Chosen best;
  for (const DriveFamily family : tried_families(rig.settings())) {
    if (is_set(options.cancel)) break;
    result.families.push_back(searcher.search(family, best));
  }
  result.stopped = is_set(options.cancel);
  if (best.point.size() == 0) {
    if (result.stopped) throw Error(ExitCode::stopped, "design: stopped before a drive was found");
    throw NoResultError(
        fmt::format("design: none of {} drives stays within the limits of [design]",
                    rig.settings().evaluations * static_cast<int>(result.families.size())));
  }
  rig.finish();
  const DriveShape shape = drive_shape(best.family, best.point, searcher.grid());
  result.family = best.family;
  result.drive = shape.parts;
  result.time_s = rig.time_s();
  check_finely(rig, datasets::drive_unit(campaign), shape, result);
  const Eigen::MatrixXd rows = rig.sensitivities(result.samples, kFineTolerance);
  if (rows.size() == 0) throw NoResultError("design: the drive has no sensitivities");
  const auto sd = searcher.standard_deviations(rows);
  for (std::size_t j = 0; j < sd.size(); ++j) {
    const bool is_named = std::find(named.begin(), named.end(), j) != named.end();
    result.parameters.push_back(
        {parameter_at(rig.problem(), rig.z(), j), is_named, sd[j], std::nullopt});
  }
  rig.play(result.samples);
  leave_symmetric_open(rig, options.threads, result);
  add_own_signals(campaign, records, values, options.threads, result);
  for (const std::string& name : uncertain_names(rig.problem()))
    result.messages.push_back(
        fmt::format("these figures do not include the uncertainty of {}; a fit does", name));
  return result;
}

}  // namespace rigcal::calib
