#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/json/described.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// Origin of a result, stored in every result file.
struct StoredProvenance {
  std::string version;
  std::string revision;
  std::string machine;
  std::string command;
  std::uint64_t seed = 0;
  Keyed<std::string> options;
  std::vector<InputFile> inputs;
  Omittable<std::vector<InputFile>> files;  ///< files of the result itself
  RIGCAL_DESCRIBE(version, revision, machine, command, seed, options, inputs, files)
};

inline StoredProvenance stored(const Provenance& provenance) {
  return {std::string(version()), std::string(revision()), machine(),         provenance.command,
          provenance.seed,        provenance.options,      provenance.inputs, std::nullopt};
}

}  // namespace rigcal::report
