#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/read/xlsx/xlsx_archive.hpp"

namespace rigcal::datasets {

/// Attributes of an element, by their names without a namespace; one that has none comes first.
class XmlAttributes {
 public:
  explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}
  std::optional<std::string_view> find(std::string_view name) const;
  /// Empty if there is none.
  std::string_view text(std::string_view name) const { return find(name).value_or(""); }

 private:
  const char** pairs_;
};

/// Receives the elements of a part, in their order: those of the namespace of its outermost
/// element, which Excel and others abbreviate differently. What other programs added in namespaces
/// of their own is passed over with all that it holds.
class XmlHandler {
 public:
  XmlHandler() = default;
  XmlHandler(const XmlHandler&) = delete;
  XmlHandler& operator=(const XmlHandler&) = delete;
  virtual ~XmlHandler() = default;

  virtual void start(std::string_view element, const XmlAttributes& attributes) = 0;
  virtual void end(std::string_view /*element*/) {}
  virtual void text(std::string_view /*text*/) {}
  /// Here an element of another namespace is passed over.
  virtual void foreign() {}
  /// The rest of the part is not wanted.
  virtual bool is_done() const { return false; }
};

/// Reads a part of a workbook as XML, by Expat.
///
/// @throws InputError  as XlsxArchive::read; not XML; with a document type, which no workbook has
///                     and which may define endless entities; with a tag of more than 1 MB
void read_xml(const XlsxArchive& archive, const std::string& part, std::uint64_t most_bytes,
              XmlHandler& handler);

}  // namespace rigcal::datasets
