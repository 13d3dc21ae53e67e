#pragma once

namespace rigcal::report::doc {

/// A visitor composed of several lambdas.
template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // deduction guide needed by clang 14

}  // namespace rigcal::report::doc
