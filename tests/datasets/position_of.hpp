#pragma once

#include "datasets/record.hpp"

namespace rigcal::test {

inline const datasets::Series& position_of(const datasets::Record& record) {
  return record.channels.at(datasets::Channel::position);
}

}  // namespace rigcal::test
