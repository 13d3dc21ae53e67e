#pragma once

#include <string_view>

namespace rigcal::report {

/// Returns the model as a gzip-compressed WebAssembly module (model/wasm). Empty if the program was
/// built without it.
std::string_view live_module();

}  // namespace rigcal::report
