#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "report/comparison/comparison.hpp"
#include "report/store/stored.hpp"

namespace rigcal::test {

/// Makes a reader from a function that returns the text of a file, or std::nullopt.
template <typename Text>
report::ReadFile reading(Text text) {
  return [text = std::move(text)](
             const std::filesystem::path& path) -> std::shared_ptr<const report::ResultFile> {
    std::optional<std::string> content = text(path);
    if (!content) return nullptr;
    return std::make_shared<const report::ResultFile>(
        report::ResultFile{path, std::move(*content)});
  };
}

/// A residual_tests.json without curves.
inline constexpr const char* kNoCurves =
    R"({"status": "converged", "schema": "rigcal.residual_tests/1", "of": "rigcal.fit/1",
        "conditions": {}})";

/// A result in JSON that is compared with others.
struct ComparedJson {
  std::string name;
  std::filesystem::path file;
  nlohmann::ordered_json result;

  operator report::Compared() const { return report::compared_of(result, file, name); }
};

/// Returns a small result in the format of fit.json.
inline nlohmann::ordered_json stored_result() {
  return nlohmann::ordered_json::parse(R"({
    "status": "converged", "schema": "rigcal.fit/1", "verdict": "PASS", "message": "converged",
    "assessment": {
      "agreement": {"state": "pass", "reasons": [{"code": "limits_kept", "state": "pass",
        "subject": "sine", "numbers": {"conditions": 1}, "words": "sine keeps its limits"}]},
      "validation": {"state": "pass", "reasons": []},
      "adequacy": {"state": "pass", "reasons": []},
      "parameters": {"state": "pass", "reasons": []}},
    "campaign": "rig", "synthetic": false, "cost": 10.5, "residual_count": 100, "evaluations": 3,
    "wall_seconds": 0.1, "simulation_tolerance": 1e-7,
    "parameters": [
      {"name": "mass_kg", "key": "mass", "symbol": "m", "unit": "kg", "scope": "rig", "level": null,
       "value": 85.01139529, "start": 60, "lower": 10, "upper": 500, "fitted": true,
       "nuisance": false, "standard_error": 0.026, "robust_standard_error": null,
       "ci95": [84.9, 85.1], "at_bound": false, "identifiability": "identified", "reason": ""},
      {"name": "supply_pressure_pa", "key": "supply_pressure", "symbol": "P_s", "unit": "Pa",
       "scope": "rig", "level": null, "value": 6.2e6, "start": 6.2e6, "lower": null, "upper": null,
       "fitted": false, "nuisance": false, "standard_error": null, "robust_standard_error": null,
       "ci95": null, "at_bound": false, "identifiability": null, "reason": ""}],
    "correlation": {"names": ["mass"], "matrix": [[1.0]]}, "rank": 1, "singular_values": [1.0],
    "reduced_chi_square": 1.01,
    "validity": {"frequency_hz": [0.1, 10], "amplitude_m": [0.05, 0.05], "amplitude_v": null,
      "supply_pressure_pa": null, "leakage_coefficient": null, "leak_levels": ["none"]},
    "acceptance": [{"channel": "position", "metric": "rho2", "limit": 0.9, "warn": 0.95}],
    "conditions": [{"id": "sine", "waveform": "sine", "frequency_hz": 2.0, "amplitude_m": 0.005,
      "leak_level": "none", "use": "fit", "samples": 4, "failure": null,
      "metrics": {"position": {"rho2": 0.99876543, "r": 0.999, "ccc": 0.998,
        "absolute_error_percent": 0.5, "rmse": 1e-5, "nrmse_fit_percent": 96.0,
        "maximum_error": 2e-5, "gain_ratio": 1.0, "phase_deg": 0.1, "delay_s": 1e-4,
        "problem": null}},
      "noise_floor": {"position": null}, "residual_tests": {"position": null},
      "limit_checks": [{"channel": "position", "metric": "rho2", "value": 0.99876543, "limit": 0.9,
        "warn": 0.95, "tolerance_used": 0.0123457, "verdict": "PASS"}],
      "channel_verdicts": {"position": "PASS"}, "verdict": "PASS", "reasons": []}],
    "groups": [], "starts": [], "best_start": 0, "failure_count": 0, "failures": [], "warnings": [],
    "provenance": {"version": "0", "revision": "r", "machine": "m", "command": "rigcal fit",
      "seed": 1, "options": {}, "inputs": []}})");
}

}  // namespace rigcal::test
