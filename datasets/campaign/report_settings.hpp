#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::datasets {

/// A key in [report], with its label on the page.
struct ReportField {
  std::string_view key, label;
};

/// What a test report must state in addition to results (ISO/IEC 17025:2017, 7.8.2), in the order
/// on the page.
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

/// Keys of a [[report.sensor]].
inline constexpr std::array kSensorFields{
    ReportField{"channel", "Channel"},
    ReportField{"instrument", "Instrument"},
    ReportField{"serial_number", "Serial number"},
    ReportField{"calibrated", "Calibrated"},
    ReportField{"due", "Due"},
    ReportField{"certificate", "Certificate"},
    ReportField{"uncertainty", "Uncertainty"},
};

/// [report]: texts as given in the campaign, dates in ISO 8601.
struct ReportSettings {
  using Fields = std::vector<std::pair<std::string, std::string>>;  ///< key, text
  Fields fields;                ///< given fields, in the order of kReportFields
  std::vector<Fields> sensors;  ///< given fields for each sensor

  bool empty() const { return fields.empty() && sensors.empty(); }
};

/// Returns the text for a key; empty if it is not given.
std::string text_of(const ReportSettings::Fields& fields, std::string_view key);

/// Standard uncertainty of a sensor, read from a text.
struct StatedUncertainty {
  std::optional<double> gain_sd;    ///< relative
  std::optional<double> offset_sd;  ///< SI
  std::string problem;  ///< in words: why the text states no uncertainty; otherwise empty
};

/// Reads an expanded uncertainty: "0.02 mm (k = 2)" applies to the offset, "0.1 % (k = 2)" to the
/// gain. Division by k gives the standard uncertainty (JCGM 100:2008, 6.2). Any other text states
/// no uncertainty.
///
/// @param unit  SI unit of the sensor's channel
StatedUncertainty stated_uncertainty(std::string_view text, std::string_view unit);

}  // namespace rigcal::datasets
