#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace rigcal::test {

/// All lines with the given name in tests/golden/statistics.txt, in their order.
inline std::vector<std::vector<double>> golden_lines(const std::string& name) {
  std::ifstream file(RIGCAL_SOURCE_DIR "/tests/golden/statistics.txt");
  std::vector<std::vector<double>> found;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != name) continue;
    std::vector<double>& values = found.emplace_back();
    for (double value = 0.0; words >> value;) values.push_back(value);
  }
  if (found.empty()) throw std::runtime_error("statistics.txt has no " + name);
  return found;
}

/// The first line with the given name.
inline std::vector<double> golden(const std::string& name) { return golden_lines(name).at(0); }

}  // namespace rigcal::test
