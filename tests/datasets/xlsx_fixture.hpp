#pragma once

#include <fmt/format.h>
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace rigcal::test {

/// Writes a ZIP archive with these files.
/// @param squeezed  whether to compress the files instead of storing them
inline void write_zip(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, std::string>>& files,
                      bool squeezed = true) {
  std::filesystem::create_directories(path.parent_path());
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  if (archive == nullptr) throw std::runtime_error("cannot write " + path.string());
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) throw std::runtime_error("cannot write into " + path.string());
    const auto place = static_cast<zip_uint64_t>(index);
    zip_set_file_compression(archive, place, squeezed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 1);
    zip_file_set_mtime(archive, place, 1'700'000'000, 0);  // gives the same bytes at any time
  }
  if (zip_close(archive) != 0) throw std::runtime_error("cannot close " + path.string());
}

/// Cell of a row, as XML. It is made from a number, a text, or given XML.
struct XlsxFixtureCell {
  std::string xml;
};
inline XlsxFixtureCell cell(double value) {
  return {fmt::format("<c r=\"@\"><v>{}</v></c>", value)};
}
inline XlsxFixtureCell cell(int value) { return cell(static_cast<double>(value)); }
inline XlsxFixtureCell cell(const std::string& text) {
  return {fmt::format("<c r=\"@\" t=\"inlineStr\"><is><t>{}</t></is></c>", text)};
}
inline XlsxFixtureCell cell(const char* text) { return cell(std::string(text)); }
/// Returns a cell given as XML, in which "@" is replaced with its address.
inline XlsxFixtureCell raw_cell(const std::string& xml) { return {xml}; }
inline XlsxFixtureCell no_cell() { return {}; }

using XlsxRows = std::vector<std::vector<XlsxFixtureCell>>;

/// Letters of a column counted from 0, such as "AB" for 27. Written independently of the reader.
inline std::string column_letters(std::size_t column) {
  std::string letters(1, static_cast<char>('A' + column % 26));
  return column < 26 ? letters : column_letters(column / 26 - 1) + letters;
}

/// Returns the XML of a sheet.
/// @param behind  XML after the rows, such as merged cells
inline std::string sheet_xml(const XlsxRows& rows, const std::string& behind = "") {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<worksheet "
      "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><sheetData>";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].empty()) continue;
    text += fmt::format("<row r=\"{}\">", i + 1);
    for (std::size_t k = 0; k < rows[i].size(); ++k) {
      std::string xml = rows[i][k].xml;
      const std::string address = column_letters(k) + std::to_string(i + 1);
      if (const std::size_t at = xml.find('@'); at != std::string::npos)
        xml.replace(at, 1, address);
      text += xml;
    }
    text += "</row>";
  }
  return text + "</sheetData>" + behind + "</worksheet>";
}

/// Returns all parts of a workbook with these sheets. Style 1 shows a date, style 2 is "0.00
/// \"mm\"", and style 3 shows minutes and seconds in a custom format.
inline std::vector<std::pair<std::string, std::string>> xlsx_parts(
    const std::vector<std::pair<std::string, std::string>>& sheets) {
  const std::string main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
  const std::string office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
  const std::string package = "http://schemas.openxmlformats.org/package/2006/relationships";
  std::string list;
  std::string references;
  std::vector<std::pair<std::string, std::string>> parts;
  for (std::size_t i = 1; i <= sheets.size(); ++i) {
    list += fmt::format("<sheet name=\"{0}\" sheetId=\"{1}\" r:id=\"rId{1}\"/>",
                        sheets[i - 1].first, i);
    references += fmt::format(
        "<Relationship Id=\"rId{0}\" Type=\"{1}/worksheet\" Target=\"worksheets/sheet{0}.xml\"/>",
        i, office);
    parts.emplace_back(fmt::format("xl/worksheets/sheet{}.xml", i), sheets[i - 1].second);
  }
  references += fmt::format(
      "<Relationship Id=\"rId90\" Type=\"{0}/styles\" Target=\"/xl/styles.xml\"/>"
      "<Relationship Id=\"rId91\" Type=\"{0}/sharedStrings\" Target=\"sharedStrings.xml\"/>",
      office);
  parts.emplace_back("_rels/.rels",
                     fmt::format("<Relationships xmlns=\"{}\"><Relationship Id=\"rId1\" "
                                 "Type=\"{}/officeDocument\" "
                                 "Target=\"xl/workbook.xml\"/></Relationships>",
                                 package, office));
  parts.emplace_back("xl/workbook.xml",
                     fmt::format("<workbook xmlns=\"{}\" xmlns:r=\"{}\"><sheets>{}</sheets>"
                                 "</workbook>",
                                 main, office, list));
  parts.emplace_back(
      "xl/_rels/workbook.xml.rels",
      fmt::format("<Relationships xmlns=\"{}\">{}</Relationships>", package, references));
  parts.emplace_back(
      "xl/styles.xml",
      fmt::format("<styleSheet xmlns=\"{}\"><numFmts count=\"2\"><numFmt numFmtId=\"164\" "
                  "formatCode=\"0.00 &quot;mm&quot;\"/><numFmt numFmtId=\"165\" "
                  "formatCode=\"mm:ss.000\"/></numFmts><cellStyleXfs><xf numFmtId=\"14\"/>"
                  "</cellStyleXfs><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"14\"/>"
                  "<xf numFmtId=\"164\"/><xf numFmtId=\"165\"/></cellXfs></styleSheet>",
                  main));
  parts.emplace_back("xl/sharedStrings.xml",
                     fmt::format("<sst xmlns=\"{}\"><si><t>t</t></si><si><r><t>x </t></r><r><t>[mm]"
                                 "</t></r><rPh sb=\"0\" eb=\"1\"><t>aid</t></rPh></si></sst>",
                                 main));
  return parts;
}

inline void write_xlsx(const std::filesystem::path& path,
                       const std::vector<std::pair<std::string, XlsxRows>>& sheets) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& [name, rows] : sheets) texts.emplace_back(name, sheet_xml(rows));
  write_zip(path, xlsx_parts(texts));
}

}  // namespace rigcal::test
