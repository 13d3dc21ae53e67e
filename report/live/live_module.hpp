#pragma once

#include <string_view>

namespace rigcal::report {

/// The model as a WebAssembly module (model/wasm), compressed by gzip. Empty if the program was
/// built without it.
std::string_view live_module();

}  // namespace rigcal::report
