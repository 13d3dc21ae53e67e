#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/read/xlsx/xlsx_archive.hpp"

namespace rigcal::datasets {

/// Attributes of an element, looked up by name without namespace. An attribute that has no
/// namespace takes priority.
class XmlAttributes {
 public:
  explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}
  std::optional<std::string_view> find(std::string_view name) const;
  /// Returns an empty text if there is no such attribute.
  std::string_view text(std::string_view name) const { return find(name).value_or(""); }

 private:
  const char** pairs_;
};

/// Receives the elements of a part in order. Only elements in the namespace of the outermost one
/// count, whatever prefix the file uses for it. Elements that other programs add in their own
/// namespaces are skipped, together with their content.
class XmlHandler {
 public:
  XmlHandler() = default;
  XmlHandler(const XmlHandler&) = delete;
  XmlHandler& operator=(const XmlHandler&) = delete;
  virtual ~XmlHandler() = default;

  virtual void start(std::string_view element, const XmlAttributes& attributes) = 0;
  virtual void end(std::string_view /*element*/) {}
  virtual void text(std::string_view /*text*/) {}
  /// Called when an element from another namespace is skipped.
  virtual void foreign() {}
  /// Whether the rest of the part is not needed.
  virtual bool is_done() const { return false; }
};

/// Reads a part of a workbook as XML, using Expat.
///
/// @throws InputError  under the conditions of XlsxArchive::read(), or if the part is not XML, has
///                     a tag of more than 1 MB, or has a document type, which no workbook has and
///                     which may define endless entities
void read_xml(const XlsxArchive& archive, const std::string& part, std::uint64_t most_bytes,
              XmlHandler& handler);

}  // namespace rigcal::datasets
