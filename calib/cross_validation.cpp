#include "calib/cross_validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "common/bytes.hpp"
#include "common/error.hpp"
#include "common/task_farm.hpp"

namespace rigcal::calib {

template <typename Archive>
void serialize(Archive& archive, HeldOut& held) {
  archive(held.condition, held.problem, held.rmse, held.fitted_rmse, held.largest_shift,
          held.shifted);
}

namespace {

using datasets::Campaign;
using datasets::Use;

/// A warning is given if the error of a prediction is this many times that of the fit, or if a
/// parameter shifts by this many standard errors.
constexpr double kMuchWorse = 1.5;
constexpr double kFarShift = 3.0;
/// A ratio below this does not count as a deterioration.
constexpr double kNoWorse = 1.005;

Campaign without(const Campaign& campaign, const std::string& id, const Fit& whole) {
  Campaign result = campaign;
  for (auto& condition : result.conditions) {
    if (condition.use == Use::validate) condition.use = Use::ignore;
    if (condition.id == id) condition.use = Use::validate;
  }
  for (auto& setting : result.parameters) {
    for (const FittedParameter& found : whole.parameters) {
      const bool same = found.fitted && found.index == setting.index &&
                        found.scope == datasets::Scope::rig && setting.fit;
      if (same) setting.value = std::clamp(found.value, setting.lower, setting.upper);
    }
  }
  return result;
}

const ConditionScore* score_of(const Fit& fit, const std::string& id) {
  const auto found = std::find_if(fit.conditions.begin(), fit.conditions.end(),
                                  [&](const ConditionScore& score) { return score.id == id; });
  return found == fit.conditions.end() ? nullptr : &*found;
}

Keyed<double, datasets::Channel> rmse_of(const ConditionScore& score) {
  Keyed<double, datasets::Channel> result;
  for (const ChannelScore& channel : score.channels) {
    if (!std::isnan(channel.metrics.rmse))
      result.emplace_back(channel.channel, channel.metrics.rmse);
  }
  return result;
}

void add_shift(const Fit& whole, const Fit& part, HeldOut& held) {
  double largest = 0.0;
  for (const FittedParameter& a : whole.parameters) {
    if (!a.fitted || a.nuisance || !a.standard_error) continue;
    const double error = a.robust_standard_error.value_or(*a.standard_error);
    if (!(error > 0.0)) continue;
    for (const FittedParameter& b : part.parameters) {
      if (!b.fitted || a.index != b.index || a.level != b.level) continue;
      const double shift = (b.value - a.value) / error;
      if (std::abs(shift) <= std::abs(largest)) continue;
      largest = shift;
      held.shifted = a.level ? fmt::format("{} ({})", a.name, *a.level) : a.name;
    }
  }
  held.largest_shift = largest;
}

HeldOut leave_out(const Campaign& campaign, const std::vector<datasets::Record>& records,
                  const std::string& id, const Fit& whole, const FitOptions& options,
                  long& evaluations) {
  HeldOut held;
  held.condition = id;
  if (const ConditionScore* fitted = score_of(whole, id)) held.fitted_rmse = rmse_of(*fitted);
  try {
    const Campaign others = without(campaign, id, whole);
    const Fit part = fit(others, records, options);
    evaluations = part.evaluations;
    const ConditionScore* predicted = score_of(part, id);
    if (part.status != FitStatus::converged) {
      held.problem = "the fit of the others: " + part.message;
    } else if (predicted == nullptr || predicted->failure) {
      held.problem = predicted == nullptr ? "not predicted" : *predicted->failure;
    } else {
      held.rmse = rmse_of(*predicted);
      add_shift(whole, part, held);
    }
  } catch (const InputError& error) {  // no other record determines one of the unknowns
    held.problem = error.what();
  }
  return held;
}

}  // namespace

std::vector<HeldOut> cross_validate(const Campaign& campaign,
                                    const std::vector<datasets::Record>& records, const Fit& whole,
                                    const FitOptions& options, Budget& left) {
  std::vector<std::string> ids;
  for (const auto& condition : campaign.conditions) {
    if (condition.use == Use::fit) ids.push_back(condition.id);
  }
  FitOptions once;
  once.seed = options.seed;
  once.consider = false;
  once.max_iterations = options.max_iterations;
  once.cancel = options.cancel;
  std::vector<HeldOut> result(ids.size());
  if (ids.size() == 1) {
    result[0].condition = ids[0];
    result[0].problem = "it is the only condition of the fit: expected at least two";
    return result;
  }
  const std::optional<long> allowed = left.evaluations_left();
  std::vector<long> taken(ids.size(), 0);
  std::atomic<int> done = 0;
  const auto not_made = [&](std::size_t i) {
    HeldOut none;
    none.condition = ids[i];
    none.problem = "not left out: " + left.reason();
    return none;
  };
  const auto make = [&](std::size_t i) -> TaskResult {
    if (left.spent()) return {{}, false};
    FitOptions fold = once;
    if (left.deadline()) {
      const std::chrono::duration<double> time = *left.deadline() - Budget::Clock::now();
      fold.max_seconds = std::max(1e-3, time.count());
    }
    long evaluations = 0;
    const HeldOut held = leave_out(campaign, records, ids[i], whole, fold, evaluations);
    left.count(evaluations);
    return {to_bytes(evaluations, held), !left.interrupted()};
  };
  const auto tell = [&](std::size_t /*i*/, const TaskResult& made) {
    if (options.beside && made.whole)
      options.beside("conditions left out", ++done, static_cast<int>(ids.size()));
  };
  ThreadFarm threads;
  TaskFarm& farm = options.farm != nullptr ? *options.farm : threads;
  std::vector<double> values;
  for (const FittedParameter& each : whole.parameters) values.push_back(each.value);
  const auto made =
      farm.run({"folds", to_bytes(values, options.seed), ids.size(), options.threads}, make, tell);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    result[i] = not_made(i);
    if (!made[i].bytes.empty()) from_bytes(made[i].bytes, taken[i], result[i]);
  }
  // Discards the folds after the one that reached the limit, because how many of them were computed
  // depends on the number of threads.
  long sum = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (allowed && sum >= *allowed) result[i] = not_made(i);
    sum += taken[i];
  }
  return result;
}

std::string cross_validation_summary(const std::vector<HeldOut>& held_out) {
  int predicted = 0;
  double worst = 0.0;
  std::string where;
  for (const HeldOut& held : held_out) {
    if (!held.problem) ++predicted;
    for (const auto& [channel, rms] : held.rmse) {
      for (const auto& [fitted_channel, fitted] : held.fitted_rmse) {
        if (fitted_channel != channel || !(fitted > 0.0) || rms / fitted <= worst) continue;
        worst = rms / fitted;
        where = fmt::format("{} of \"{}\"", datasets::info(channel).key, held.condition);
      }
    }
  }
  if (where.empty()) return "cross-validation: no condition could be predicted from the others";
  const std::string error =
      worst <= kNoWorse
          ? "each with the error of the fit"
          : fmt::format("the error at most {:.3g} times that of the fit ({})", worst, where);
  return fmt::format("cross-validation: {} of {} conditions predicted from the others, {}",
                     predicted, held_out.size(), error);
}

std::vector<std::string> cross_validation_words(const std::vector<HeldOut>& held_out) {
  std::vector<std::string> words;
  for (const HeldOut& held : held_out) {
    if (held.problem) {
      words.push_back(fmt::format("condition \"{}\" left out: no prediction ({})", held.condition,
                                  *held.problem));
      continue;
    }
    for (const auto& [channel, rms] : held.rmse) {
      for (const auto& [fitted_channel, fitted] : held.fitted_rmse) {
        if (fitted_channel != channel || !(rms > kMuchWorse * fitted)) continue;
        words.push_back(fmt::format(
            "condition \"{}\" left out: {} is predicted {:.3g} times worse than it is fitted",
            held.condition, datasets::info(channel).key, rms / fitted));
      }
    }
    if (held.shifted && std::abs(held.largest_shift.value_or(0.0)) > kFarShift) {
      words.push_back(
          fmt::format("condition \"{}\" left out: {} changes by {:.2g} standard errors, so this "
                      "condition determines it or contradicts the others",
                      held.condition, *held.shifted, *held.largest_shift));
    }
  }
  return words;
}

}  // namespace rigcal::calib
