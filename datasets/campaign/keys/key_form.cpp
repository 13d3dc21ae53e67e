#include "datasets/campaign/keys/key_form.hpp"

#include <algorithm>
#include <utility>

#include "common/quantity.hpp"

namespace rigcal::datasets {
namespace {

/// Removes the article: "a pressure" becomes "pressure".
std::string without_article(std::string_view name) {
  return std::string(name.substr(name.find(' ') + 1));
}

}  // namespace

KeyForm quantity_form(std::string_view unit) {
  return quantity_form(std::vector<std::string>{std::string(unit)});
}

KeyForm quantity_form(std::vector<std::string> units) {
  KeyForm form;
  const bool plain = units.size() == 1 && units[0] == "1";
  form.kind = plain ? KeyForm::Kind::number : KeyForm::Kind::quantity;
  if (!plain) form.units = std::move(units);
  return form;
}

KeyForm number_form(QuantityRange range) {
  KeyForm form = plain_form(KeyForm::Kind::number);
  form.lower = range.lower;
  form.upper = range.upper;
  return form;
}

KeyForm whole_form(double lower, double upper) {
  KeyForm form = number_form({lower, upper});
  form.kind = KeyForm::Kind::whole;
  return form;
}

KeyForm plain_form(KeyForm::Kind kind, std::string name) {
  KeyForm form;
  form.kind = kind;
  form.name = std::move(name);
  return form;
}

KeyForm word_form(std::vector<std::string> words) {
  KeyForm form = plain_form(KeyForm::Kind::word);
  form.words = std::move(words);
  return form;
}

KeyForm list_form(KeyForm item, std::string name, std::size_t least, std::size_t most) {
  KeyForm form = plain_form(KeyForm::Kind::list, std::move(name));
  form.forms.push_back(std::move(item));
  form.least = least;
  form.most = most;
  return form;
}

KeyForm entries_form(KeyForm value, std::string name) {
  KeyForm form = plain_form(KeyForm::Kind::entries, std::move(name));
  form.forms.push_back(std::move(value));
  return form;
}

KeyForm table_form(std::vector<CampaignKey> keys) {
  KeyForm form = plain_form(KeyForm::Kind::table);
  form.keys = std::move(keys);
  return form;
}

KeyForm either_form(std::vector<KeyForm> forms, std::string name) {
  KeyForm form = plain_form(KeyForm::Kind::either, std::move(name));
  form.forms = std::move(forms);
  return form;
}

std::string type_name(const KeyForm& form) {
  if (!form.name.empty()) return form.name;
  switch (form.kind) {
    case KeyForm::Kind::quantity: {
      const std::string name =
          form.units.size() == 1 ? without_article(dimension_name(form.units[0])) : std::string();
      return name.empty() ? "quantity" : name;
    }
    case KeyForm::Kind::number:
      return "number";
    case KeyForm::Kind::whole:
      return "whole number";
    case KeyForm::Kind::flag:
      return "boolean";
    case KeyForm::Kind::date:
      return "date";
    case KeyForm::Kind::list:
      return "list";
    case KeyForm::Kind::entries:
    case KeyForm::Kind::table:
      return "table";
    case KeyForm::Kind::text:
    case KeyForm::Kind::word:
    case KeyForm::Kind::either:
      break;
  }
  return "text";
}

std::vector<std::string> names_of(const std::vector<CampaignKey>& keys) {
  std::vector<std::string> names;
  for (const CampaignKey& each : keys) names.push_back(each.key);
  return names;
}

const CampaignKey* find_key(const std::vector<CampaignKey>& keys, std::string_view key) {
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const CampaignKey& each) { return each.key == key; });
  return found == keys.end() ? nullptr : &*found;
}

}  // namespace rigcal::datasets
