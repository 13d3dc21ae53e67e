#pragma once

#include <string_view>

namespace rigcal::datasets {

/// Whether an Excel number format shows dates or times of day: "dd.mm.yyyy", "[h]:mm:ss.000".
bool is_date_format(std::string_view code);

/// Whether the built-in Excel format with this number shows dates or times of day (ECMA-376, part
/// 1, 18.8.30).
bool is_date_format(long number);

}  // namespace rigcal::datasets
