#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::datasets {

/// A key of [report] with its label on the page.
struct ReportField {
  std::string_view key, label;
};

/// Statements of a test report in addition to its results (ISO/IEC 17025:2017, 7.8.2), in the order
/// of the page.
inline constexpr std::array kReportFields{
    ReportField{"number", "Report number"},
    ReportField{"issued", "Date of issue"},
    ReportField{"laboratory", "Laboratory"},
    ReportField{"customer", "Customer"},
    ReportField{"rig", "Rig"},
    ReportField{"specimen", "Specimen"},
    ReportField{"serial_number", "Serial number"},
    ReportField{"method", "Method"},
    ReportField{"operator", "Operator"},
    ReportField{"approver", "Approved by"},
    ReportField{"remarks", "Remarks"},
};

/// One [[report.sensor]].
inline constexpr std::array kSensorFields{
    ReportField{"channel", "Channel"},
    ReportField{"instrument", "Instrument"},
    ReportField{"serial_number", "Serial number"},
    ReportField{"calibrated", "Calibrated"},
    ReportField{"due", "Due"},
    ReportField{"certificate", "Certificate"},
    ReportField{"uncertainty", "Uncertainty"},
};

/// [report]: texts as the campaign gives them, dates as ISO 8601.
struct ReportSettings {
  using Fields = std::vector<std::pair<std::string, std::string>>;  ///< key, text
  Fields fields;                ///< the given ones, in the order of kReportFields
  std::vector<Fields> sensors;  ///< the given ones of each sensor

  bool empty() const { return fields.empty() && sensors.empty(); }
};

/// Text of a key; empty if it is not given.
std::string text_of(const ReportSettings::Fields& fields, std::string_view key);

/// Standard uncertainty of a sensor, as read from a text.
struct StatedUncertainty {
  std::optional<double> gain_sd;    ///< relative
  std::optional<double> offset_sd;  ///< SI
  std::string problem;  ///< why the text states no uncertainty, in words; empty if it does
};

/// Reads "0.02 mm (k = 2)", an expanded uncertainty of the offset, or "0.1 % (k = 2)", one of the
/// gain. Divided by k they are standard uncertainties (JCGM 100:2008, 6.2). Any other text states
/// none.
///
/// @param unit  of the sensor's channel, SI
StatedUncertainty stated_uncertainty(std::string_view text, std::string_view unit);

}  // namespace rigcal::datasets
