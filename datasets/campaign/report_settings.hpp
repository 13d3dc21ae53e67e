#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::datasets {

/// A key of [report]: an optional text or date.
struct ReportField {
  std::string_view key;
  std::string_view label;  ///< on the page
  std::string_view doc;    ///< for schema and documents
  bool is_date = false;
  bool is_fact = true;  ///< listed with item and method, not at the top or with a signature
};

/// What a test report must state in addition to results (ISO/IEC 17025:2017, 7.8.2), in the order
/// on the page.
inline constexpr std::array kReportFields{
    ReportField{"number", "Report number", "Number of the report", false, false},
    ReportField{"revision", "Revision", "Revision of the report; needs `number`", false, false},
    ReportField{"replaces", "Replaces", "The report that this one replaces; needs `number`", false,
                false},
    ReportField{"issued", "Date of issue", "Date on which the report is issued", true, false},
    ReportField{"laboratory", "Laboratory", "Who made the test", false, false},
    ReportField{"laboratory_address", "Address of the laboratory", "Address of the laboratory"},
    ReportField{"place", "Place of the test",
                "Where the test was made, if not at the laboratory's address"},
    ReportField{"customer", "Customer", "For whom it was made", false, false},
    ReportField{"customer_contact", "Contact of the customer", "Address or person of the customer"},
    ReportField{"rig", "Rig", "The rig that was tested"},
    ReportField{"specimen", "Specimen", "What was tested on it"},
    ReportField{"serial_number", "Serial number", "Serial number of the specimen"},
    ReportField{"received", "Received", "Date on which the specimen was received", true},
    ReportField{"specimen_condition", "Condition of the specimen",
                "Condition in which the specimen was tested"},
    ReportField{"method", "Method", "The procedure of the test"},
    ReportField{"deviations", "Deviations from the method",
                "Additions to the procedure, omissions and changes"},
    ReportField{"operator", "Operator", "Who made the measurements", false, false},
    ReportField{"approver", "Approved by", "Who approves the report", false, false},
    ReportField{"approver_function", "Function", "Function of the approver; needs `approver`",
                false, false},
    ReportField{"remarks", "Remarks", "Further remarks"},
};

/// Keys of a [[report.sensor]].
inline constexpr std::array kSensorFields{
    ReportField{"channel", "Channel",
                "The channel of `[recording.channels]` that the sensor measures"},
    ReportField{"instrument", "Instrument", "Kind and range of the sensor"},
    ReportField{"serial_number", "Serial number", "Serial number of the sensor"},
    ReportField{"calibrated", "Calibrated", "Date of its calibration", true},
    ReportField{"due", "Due", "Date on which its calibration ends", true},
    ReportField{"certificate", "Certificate", "Number of its certificate"},
    ReportField{"uncertainty", "Uncertainty",
                "`\"NUMBER UNIT (k = N)\"` of its offset, or `\"NUMBER % (k = N)\"` of its gain; "
                "any other text is not used, and causes a reservation"},
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
