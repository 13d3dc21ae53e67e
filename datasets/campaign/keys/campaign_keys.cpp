#include "datasets/campaign/keys/campaign_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/compact_json.hpp"
#include "common/quantity.hpp"

namespace rigcal::datasets {
namespace {

using OrderedJson = nlohmann::ordered_json;
using FormKind = KeyForm::Kind;

/// Matches the number at the beginning of a quantity.
constexpr std::string_view kNumberPattern =
    R"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)";

bool fits_any(const std::string& from, const std::vector<std::string>& to) {
  return std::any_of(to.begin(), to.end(), [&](const std::string& unit) {
    try {
      unit_conversion(from, unit);
      return true;
    } catch (const QuantityError&) {
      return false;
    }
  });
}

/// Returns a pattern that refuses text without a number or unit, and the common units of other
/// dimensions. There are too many suitable units to list them all.
std::string quantity_pattern(const std::vector<std::string>& units) {
  std::string wrong;
  for (const std::string& unit : common_units())
    if (unit != "1" && !units.empty() && !fits_any(unit, units)) wrong += unit + "|";
  // The last alternative is empty and matches a missing unit.
  return fmt::format(R"(^(?!\s*{0}\s*(?:{1})\s*$)\s*{0}\s*\S)", kNumberPattern, wrong);
}

std::string definition_name(const std::vector<std::string>& units) {
  std::string name = units.empty() ? "quantity" : fmt::format("{}", fmt::join(units, "_or_"));
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

class SchemaWriter {
 public:
  OrderedJson table(const std::vector<CampaignKey>& keys) {
    OrderedJson properties = OrderedJson::object();
    OrderedJson required = OrderedJson::array();
    for (const CampaignKey& row : keys) {
      properties[row.key] = entry(row);
      if (row.needed) required.push_back(row.key);
    }
    OrderedJson schema{{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = std::move(required);
    schema["additionalProperties"] = false;
    return schema;
  }

  OrderedJson definitions() const { return definitions_; }

 private:
  /// Returns the schema of a key, with the description, default and example that an editor shows.
  /// Editors ignore other members next to a `$ref`.
  OrderedJson entry(const CampaignKey& row) {
    OrderedJson schema = OrderedJson::object();
    std::string about = row.doc;
    if (!row.otherwise.empty() && row.otherwise != "none" && !row.needed)
      about += fmt::format("{}Default: {}", about.empty() ? "" : ". ", row.otherwise);
    if (!about.empty()) schema["description"] = about;
    if (!row.standard.empty()) schema["default"] = OrderedJson::parse(row.standard);
    const OrderedJson example = OrderedJson::parse(row.example, nullptr, false);
    if (!example.is_discarded()) schema["examples"] = OrderedJson::array({example});
    OrderedJson rules = form(row.form);
    if (rules.contains("$ref")) rules = {{"anyOf", OrderedJson::array({std::move(rules)})}};
    schema.update(rules);
    return schema;
  }

  OrderedJson form(const KeyForm& form) {
    switch (form.kind) {
      case FormKind::quantity:
        return quantity(form.units);
      case FormKind::number:
        return number("number", form);
      case FormKind::whole:
        return number("integer", form);
      case FormKind::flag:
        return {{"type", "boolean"}};
      case FormKind::text:
        return {{"type", "string"}};
      case FormKind::word:
        return {{"enum", form.words}};
      case FormKind::date:
        return {{"type", "string"}, {"pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}"}};
      case FormKind::list:
        return list(form);
      case FormKind::entries:
        return {{"type", "object"}, {"additionalProperties", this->form(form.forms.at(0))}};
      case FormKind::table:
        return table(form.keys);
      case FormKind::either:
        break;
    }
    OrderedJson any = OrderedJson::array();
    for (const KeyForm& each : form.forms) any.push_back(this->form(each));
    return {{"anyOf", std::move(any)}};
  }

  OrderedJson list(const KeyForm& form) {
    OrderedJson schema{{"type", "array"}, {"items", this->form(form.forms.at(0))}};
    if (form.least > 0) schema["minItems"] = form.least;
    if (form.most > 0) schema["maxItems"] = form.most;
    return schema;
  }

  static OrderedJson number(const char* type, const KeyForm& form) {
    OrderedJson schema{{"type", type}};
    const auto limit = [&](const char* key, double value) {
      if (!std::isfinite(value)) return;
      if (form.kind == FormKind::whole) {
        schema[key] = std::llround(value);
      } else {
        schema[key] = value;
      }
    };
    limit(form.above_lower ? "exclusiveMinimum" : "minimum", form.lower);
    limit(form.below_upper ? "exclusiveMaximum" : "maximum", form.upper);
    return schema;
  }

  OrderedJson quantity(const std::vector<std::string>& units) {
    const std::string name = definition_name(units);
    if (!definitions_.contains(name)) {
      const std::string what = type_name(quantity_form(units));
      definitions_[name] = {
          {"description",
           fmt::format("A {} as text: number and unit{}", what,
                       units.empty() ? "" : fmt::format(", in SI {}", fmt::join(units, " or ")))},
          {"type", "string"},
          {"pattern", quantity_pattern(units)}};
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  OrderedJson definitions_ = OrderedJson::object();
};

bool is_table(const OrderedJson& schema) {
  return schema.is_object() && schema.contains("properties") && schema["properties"].is_object() &&
         schema.contains("additionalProperties");
}

/// Moves tables that occur several times into the definitions. Most parameters and channels with
/// the same unit have equal tables.
class SharedTables {
 public:
  explicit SharedTables(const OrderedJson& schema) { count(schema); }

  OrderedJson without_copies(const OrderedJson& schema) {
    if (!schema.is_structured()) return schema;
    if (is_table(schema)) {
      const OrderedJson table = bare(schema);
      const std::string text = table.dump();
      if (counts_[text] > 1) {
        const auto [name, is_new] =
            names_.emplace(text, fmt::format("table_{}", names_.size() + 1));
        if (is_new) definitions_[name->second] = parts_of(table);
        OrderedJson result = OrderedJson::object();
        for (const char* key : kAnnotations)
          if (schema.contains(key)) result[key] = schema[key];
        const OrderedJson reference{{"$ref", "#/$defs/" + name->second}};
        if (result.empty()) return reference;
        result["anyOf"] = OrderedJson::array({reference});
        return result;
      }
    }
    return parts_of(schema);
  }

  const OrderedJson& definitions() const { return definitions_; }

 private:
  static constexpr std::array kAnnotations{"description", "default", "examples"};

  static OrderedJson bare(OrderedJson schema) {
    for (const char* key : kAnnotations) schema.erase(key);
    return schema;
  }

  void count(const OrderedJson& schema) {
    if (is_table(schema)) ++counts_[bare(schema).dump()];
    if (!schema.is_structured()) return;
    for (const OrderedJson& part : schema) count(part);
  }

  OrderedJson parts_of(OrderedJson schema) {
    for (OrderedJson& part : schema) part = without_copies(part);
    return schema;
  }

  std::map<std::string, int> counts_;
  std::map<std::string, std::string> names_;
  OrderedJson definitions_ = OrderedJson::object();
};

/// Returns the table within a form, or null if there is none.
const std::vector<CampaignKey>* table_in(const KeyForm& form) {
  if (form.kind == FormKind::table) return &form.keys;
  if (form.kind != FormKind::list && form.kind != FormKind::entries &&
      form.kind != FormKind::either)
    return nullptr;
  for (const KeyForm& each : form.forms)
    if (const auto* keys = table_in(each)) return keys;
  return nullptr;
}

/// Escapes a text for a cell of a Markdown table.
std::string escaped(std::string_view text) {
  std::string cell;
  for (const char c : text) cell.append(c == '|' ? "\\" : "").push_back(c);
  return cell;
}

/// Returns the limits as in ", 0 to 1". Empty if there are none, or if the upper limit is too large
/// to matter.
std::string limits_text(const KeyForm& form) {
  constexpr double kLarge = 1e6;
  const bool from = std::isfinite(form.lower);
  const bool to = std::isfinite(form.upper);
  if (!from && !to) return {};
  if (to && form.upper > kLarge) return {};
  if (!to) return fmt::format(", from {:g}", form.lower);
  const auto upper = fmt::format("{}{}", form.below_upper ? "below " : "", form.upper);
  if (!from) return fmt::format(", to {}", upper);
  return fmt::format(", {}{:g} to {}", form.above_lower ? "above " : "", form.lower, upper);
}

/// Returns the type of a key for the documents, including its words or the limits of its number.
std::string type_text(const KeyForm& form) {
  if (form.kind == FormKind::number || form.kind == FormKind::whole)
    return type_name(form) + limits_text(form);
  if (form.kind != FormKind::word) return type_name(form);
  std::vector<std::string> quoted;
  for (const std::string& word : form.words)
    quoted.push_back(fmt::format("`\"{}\"`", word == "\t" ? "\\t" : word));
  return fmt::format("{}", fmt::join(quoted, ", "));
}

}  // namespace

const std::vector<CampaignKey>* find_campaign_table(std::string_view path) {
  const std::vector<CampaignKey>* keys = &campaign_keys();
  while (!path.empty() && keys != nullptr) {
    const std::string_view part = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(path.size(), part.size() + 1));
    const CampaignKey* row = find_key(*keys, part);
    keys = row == nullptr ? nullptr : table_in(row->form);
  }
  return keys;
}

std::string campaign_schema() {
  SchemaWriter writer;
  OrderedJson schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                     {"title", "Campaign file of rigcal"},
                     {"description",
                      "For editors. rigcal rejects whatever this schema rejects; `rigcal check` "
                      "also checks ranges, all units, and keys that depend on one another"}};
  const OrderedJson root = writer.table(campaign_keys());
  SharedTables shared(root);
  schema.update(shared.without_copies(root));
  schema["$defs"] = writer.definitions();
  schema["$defs"].update(shared.definitions());
  return compact_json(schema, " ") + "\n";
}

std::string markdown_of(const std::vector<CampaignKey>& keys) {
  std::string text = "| key | type | default | meaning |\n| --- | --- | --- | --- |\n";
  std::string names;
  std::string last;
  const auto finish = [&] {
    if (!names.empty()) text += fmt::format("| {} | {} |\n", names, last);
    names.clear();
  };
  for (const CampaignKey& row : keys) {
    const std::string standard = row.needed             ? "needed"
                                 : row.standard.empty() ? row.otherwise
                                                        : fmt::format("`{}`", row.standard);
    const std::string rest =
        fmt::format("{} | {} | {}", type_text(row.form), standard, escaped(row.doc));
    // Consecutive keys with the same meaning share a line.
    if (rest != last) finish();
    names += fmt::format("{}`{}`", names.empty() ? "" : ", ", row.key);
    last = rest;
  }
  finish();
  return text;
}

std::string draft_line(std::string_view table, std::string_view key) {
  const auto* keys = find_campaign_table(table);
  const CampaignKey* row = keys == nullptr ? nullptr : find_key(*keys, key);
  if (row == nullptr || row->example.empty())
    throw std::invalid_argument(fmt::format("draft_line: no example of {}.{}", table, key));
  return fmt::format("{} = {}{}{}\n", key, row->example, row->hint.empty() ? "" : "  # ",
                     row->hint);
}

}  // namespace rigcal::datasets
