#include "datasets/campaign/toml/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

#include "datasets/campaign/toml/toml_reader.hpp"

namespace rigcal::datasets {
namespace {

struct Entry {
  std::string key;
  const toml::node* node;
};

/// Returns line and column of a key, for sorting. An added key has no line in the file, and sorts
/// last.
std::pair<std::size_t, std::size_t> place(const toml::key& key) {
  const auto begin = key.source().begin;
  return {begin.line == 0 ? std::numeric_limits<std::size_t>::max() : begin.line, begin.column};
}

std::vector<Entry> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, Entry>> found;
  for (const auto& [key, node] : table) {
    found.push_back({place(key), Entry{std::string(key.str()), &node}});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Entry> entries;
  for (auto& entry : found) entries.push_back(std::move(entry.second));
  return entries;
}

std::string value_text(const toml::node& node) {
  if (const auto* value = node.as_string()) return toml_quoted(value->get());
  if (const auto* value = node.as_floating_point()) return toml_number(value->get());
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const toml::node& item : *array) {
      text.append(text.empty() ? "" : ", ").append(value_text(item));
    }
    return "[" + text + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const Entry& entry : in_file_order(*table)) {
      text.append(text.empty() ? " " : ", ");
      text.append(toml_key(entry.key)).append(" = ").append(value_text(*entry.node));
    }
    return "{" + text + " }";
  }
  std::ostringstream out;  // whole numbers, booleans, dates and times
  if (const auto* value = node.as_integer()) out << value->get();
  if (const auto* value = node.as_boolean()) out << (value->get() ? "true" : "false");
  if (const auto* value = node.as_date()) out << value->get();
  if (const auto* value = node.as_time()) out << value->get();
  if (const auto* value = node.as_date_time()) out << value->get();
  return out.str();
}

/// Whether a node is written in sections with headers, [path] or [[path]], and not on one line.
bool has_own_headers(const toml::node& node) {
  if (const auto* table = node.as_table()) return !table->is_inline();
  const auto* array = node.as_array();
  return array != nullptr && !array->empty() &&
         std::all_of(array->begin(), array->end(), [](const toml::node& item) {
           return item.is_table() && !item.as_table()->is_inline();
         });
}

void write_table(std::string& text, const toml::table& table, const std::string& path);

void write_section(std::string& text, const toml::node& node, const std::string& path) {
  if (const auto* array = node.as_array()) {
    for (const toml::node& item : *array) {
      text += fmt::format("\n[[{}]]\n", path);
      write_table(text, *item.as_table(), path);
    }
    return;
  }
  const toml::table& table = *node.as_table();
  const bool only_holds_sections =
      !table.empty() && std::all_of(table.begin(), table.end(), [](const auto& entry) {
        return has_own_headers(entry.second);
      });
  if (!only_holds_sections) text += fmt::format("\n[{}]\n", path);
  write_table(text, table, path);
}

void write_table(std::string& text, const toml::table& table, const std::string& path) {
  const std::vector<Entry> entries = in_file_order(table);
  for (const Entry& entry : entries) {
    if (has_own_headers(*entry.node)) continue;
    text += fmt::format("{} = {}\n", toml_key(entry.key), value_text(*entry.node));
  }
  for (const Entry& entry : entries) {
    if (!has_own_headers(*entry.node)) continue;
    const std::string key = toml_key(entry.key);
    write_section(text, *entry.node, path.empty() ? key : fmt::format("{}.{}", path, key));
  }
}

}  // namespace

std::string toml_text(const toml::table& root) {
  std::string text;
  write_table(text, root, "");
  return text;
}

}  // namespace rigcal::datasets
