#include "calib/design/trial_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/simulation_task.hpp"
#include "calib/trust/information.hpp"
#include "calib/trust/planned_record.hpp"
#include "datasets/synthetic/model_output.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Record;

constexpr double kRestTolerance = 1e-6;

/// Returns the condition of the test, with the machine settings of the condition `like` and a
/// recorded drive.
datasets::Condition tested_condition(const Campaign& campaign) {
  datasets::Condition condition;
  const datasets::DesignSettings& design = *campaign.design;
  if (design.like) {
    const datasets::Condition& like = *campaign.find(*design.like);
    condition.leak_level = like.leak_level;
    condition.overrides = like.overrides;
    condition.specimen = like.specimen;
  }
  condition.id = "design";
  condition.waveform = datasets::Waveform::recorded;
  condition.duration_s = design.duration_s;
  condition.sample_rate_hz = design.sample_rate_hz;
  condition.where = design.where;
  return condition;
}

void require_levels(const Campaign& campaign, const datasets::Condition& condition) {
  if (condition.leak_level) return;
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    if (!setting.fit || setting.scope != datasets::Scope::leak_level ||
        known_in(campaign, condition, setting.index))
      continue;
    const auto& spec = model::parameter_spec(campaign.rig.plant, setting.index);
    throw InputError(condition.where,
                     fmt::format("key 'design': {} has one value per leak level: expected like = "
                                 "\"...\", the id of a condition of the level at which the test "
                                 "will be made",
                                 spec.key));
  }
}

bool follows_position(const Campaign& campaign) {
  return campaign.rig.controller == model::ControllerKind::pid &&
         campaign.rig.feedback == model::Feedback::position;
}

}  // namespace

std::map<Channel, double> noise_of_one_repeat(const Campaign& campaign,
                                              const std::vector<Record>& records) {
  std::map<Channel, double> noise;
  const auto& stated = campaign.design->noise_sd;
  for (const Channel channel : compared_channels(campaign)) {
    const auto& listed = campaign.fit.outputs;
    if (!listed.empty() && std::find(listed.begin(), listed.end(), channel) == listed.end())
      continue;
    if (const auto own = stated.find(channel); own != stated.end()) {
      noise[channel] = own->second;
      continue;
    }
    if (const auto& sd = campaign.channels.at(channel).sd) {
      noise[channel] = *sd;
      continue;
    }
    if (campaign.synthetic_settings) {
      const auto& synthetic = campaign.synthetic_settings->noise_sd;
      if (const auto own = synthetic.find(channel); own != synthetic.end() && own->second > 0.0) {
        noise[channel] = own->second;
        continue;
      }
    }
    for (const Record& record : records) {
      const auto series = record.channels.find(channel);
      if (series != record.channels.end() && series->second.pooled_sd > 0.0) {
        noise[channel] = series->second.pooled_sd;
        break;
      }
    }
    if (noise.contains(channel)) continue;
    throw InputError(
        campaign.design->where,
        fmt::format("key 'design': the noise of channel {0} is unknown: expected noise = {{ "
                    "{0} = \"...\" }}, the standard deviation of a sample",
                    datasets::info(channel).key));
  }
  if (noise.empty())
    throw InputError(campaign.design->where,
                     "key 'design': the records will have no output channel to compare with the "
                     "model: expected an output channel such as position in [recording.channels]");
  return noise;
}

TrialRig::TrialRig(const Campaign& campaign, const std::map<Channel, double>& noise_sd,
                   const std::vector<datasets::FittedValue>* values,
                   const std::atomic<bool>* cancel)
    : campaign_(campaign), condition_(tested_condition(campaign)), cancel_(cancel) {
  require_levels(campaign_, condition_);
  datasets::ChannelSetting drive;
  drive.channel = datasets::drive_channel(campaign_);
  datasets::ChannelSetting& setting =
      campaign_.channels.emplace(drive.channel, drive).first->second;
  setting.role = datasets::ChannelRole::input;
  setting.recognise = false;
  record_.condition = condition_.id;
  record_.repeats = campaign.design->repeats;
  record_.time_s = datasets::sample_times(condition_, nullptr);
  rest(noise_sd);
  problem_ =
      std::make_unique<Problem>(make_problem(campaign_, {record_}, {&condition_}, false, nullptr));
  problem_->conditions.front().record = &record_;
  if (problem_->map.unknowns().empty())
    throw InputError({campaign.file.string()},
                     "no parameter is free: expected `fit = true` at a parameter, or --free");
  z_ = point_at(*problem_, values);
  reach_ = find_reach();
}

/// Simulates the rig at rest, to obtain its initial state and a record to use before the drive is
/// known.
void TrialRig::rest(const std::map<Channel, double>& noise_sd) {
  std::vector<model::Output> outputs(limited_outputs().begin(), limited_outputs().end());
  for (const auto& [channel, sd] : noise_sd)
    outputs.push_back(datasets::model_output(channel).value());
  model::Rig rig = campaign_.rig;
  rig.initial = model::InitialState::rest;
  model::SimulationOptions options = simulation_options(campaign_);
  options.tolerance = kRestTolerance;
  options.cancel = cancel_;
  const model::ParameterValues values = datasets::values_in(campaign_, condition_);
  const auto run_with = [&](double drive, std::span<const double> time_s) {
    model::SimulationInputs inputs;
    inputs.drive = model::Signal::constant(drive);
    const auto run = model::simulate(rig, values, {}, inputs, time_s, outputs, options);
    if (run.status == model::SimulationStatus::cancelled)
      throw Error(ExitCode::stopped, "design: stopped before a drive was found");
    if (!run.ok())
      throw NoResultError(fmt::format("design: the rig cannot be simulated at rest: {}, at {:g} s",
                                      run.reason, run.failed_at_s));
    return run.outputs;
  };
  first_position_m_ = run_with(0.0, std::span(record_.time_s).first(1))(0, 0);
  if (follows_position(campaign_)) neutral_ = first_position_m_;
  const Eigen::MatrixXd run = run_with(neutral_, record_.time_s);
  require_limits_at_rest(run);
  auto column = static_cast<Eigen::Index>(limited_outputs().size());
  for (const auto& [channel, sd] : noise_sd) {
    datasets::Series series;
    series.mean.assign(run.col(column).begin(), run.col(column).end());
    series.pooled_sd = sd;
    series.sd_of_mean = sd / std::sqrt(campaign_.design->repeats);
    series.repeats = campaign_.design->repeats;
    record_.channels[channel] = std::move(series);
    ++column;
  }
  datasets::Series drive;
  drive.mean.assign(record_.time_s.size(), neutral_);
  record_.channels[datasets::drive_channel(campaign_)] = std::move(drive);
}

void TrialRig::require_limits_at_rest(const Eigen::MatrixXd& run) const {
  for (const LimitUse& use : limit_uses(settings(), run, {})) {
    if (!(use.share > 1.0)) continue;
    throw InputError(
        use.where, fmt::format("key 'design.{}': no drive can stay within this limit: even with a "
                               "constant drive the {} reaches {:.4g} {}, the limit is {:.4g} {}",
                               use.key, use.words, use.reached, use.unit, use.limit, use.unit));
  }
}

double TrialRig::find_reach() const {
  const datasets::DesignSettings& design = settings();
  const double of_stroke = std::max(design.highest_m.value - first_position_m_,
                                    first_position_m_ - design.lowest_m.value);
  const bool commanded = campaign_.rig.controller == model::ControllerKind::none;
  double reach = 0.0;
  if (follows_position(campaign_)) reach = of_stroke;
  if (commanded && design.command_v) reach = design.command_v->value;
  if (design.amplitude)
    reach = reach > 0.0 ? std::min(reach, design.amplitude->value) : design.amplitude->value;
  if (reach > 0.0) return reach;
  const auto& channel = datasets::info(datasets::drive_channel(campaign_));
  throw InputError(design.where,
                   fmt::format("key 'design': nothing limits the drive: expected {}amplitude = "
                               "\"... {}\", its largest distance from the initial value",
                               commanded ? "command = \"10 V\", or " : "", channel.unit));
}

model::SimulationInputs TrialRig::driven_by(const std::vector<double>& drive) const {
  model::SimulationInputs inputs = problem_->conditions.front().inputs;
  const auto& setting = campaign_.channels.at(datasets::drive_channel(campaign_));
  inputs.drive = setting.interpolation == datasets::Interpolation::linear
                     ? model::Signal::linear(record_.time_s, drive)
                     : model::Signal::held(record_.time_s, drive);
  return inputs;
}

std::optional<std::vector<LimitUse>> TrialRig::uses_under(const std::vector<double>& drive,
                                                          double tolerance, int finer,
                                                          Eigen::MatrixXd* at) const {
  std::vector<double> times;
  times.reserve(record_.time_s.size() * static_cast<std::size_t>(finer));
  for (std::size_t i = 0; i < record_.time_s.size(); ++i) {
    const double t = record_.time_s[i];
    const int parts = i + 1 < record_.time_s.size() ? finer : 1;
    for (int k = 0; k < parts; ++k)
      times.push_back(k == 0 ? t : t + k / (finer * settings().sample_rate_hz));
  }
  const ProblemCondition& condition = problem_->conditions.front();
  const auto run =
      model::simulate(condition.rig, problem_->values_at(0, z_), {}, driven_by(drive), times,
                      limited_outputs(), simulation_options(*problem_, 0, tolerance, cancel_));
  if (!run.ok()) return std::nullopt;
  if (at != nullptr) {
    at->resize(static_cast<Eigen::Index>(drive.size()), run.outputs.cols());
    for (Eigen::Index i = 0; i < at->rows(); ++i) at->row(i) = run.outputs.row(i * finer);
  }
  return limit_uses(
      settings(), run.outputs,
      follows_position(campaign_) ? std::span<const double>(drive) : std::span<const double>());
}

Eigen::MatrixXd TrialRig::sensitivities(const std::vector<double>& drive, double tolerance) const {
  const ProblemCondition& condition = problem_->conditions.front();
  const auto run = model::simulate(condition.rig, problem_->values_at(0, z_), condition.free,
                                   driven_by(drive), record_.time_s, condition.outputs,
                                   simulation_options(*problem_, 0, tolerance, cancel_));
  if (!run.ok()) return {};
  const Eigen::VectorXd slopes = acting_slopes(*problem_, 0, z_);
  const std::vector<int>& acting = problem_->map.acting(0);
  const auto samples = static_cast<Eigen::Index>(drive.size());
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(samples * static_cast<Eigen::Index>(condition.channels.size()),
                            static_cast<Eigen::Index>(z_.size()));
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    for (std::size_t j = 0; j < acting.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      rows.col(acting[j]).segment(static_cast<Eigen::Index>(k) * samples, samples) =
          run.sensitivities[k].col(column) * (slopes(column) / condition.channels[k].sd);
    }
  }
  return rows;
}

void TrialRig::play(const std::vector<double>& drive) {
  problem_->conditions.front().inputs = driven_by(drive);
}

}  // namespace rigcal::calib
