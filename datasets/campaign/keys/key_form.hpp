#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {

struct CampaignKey;

/// Describes the values that a key in a campaign file accepts. The schema and the documents are
/// generated from it.
struct KeyForm {
  enum class Kind {
    quantity,  ///< "6.2 MPa"
    number,
    whole,
    flag,
    text,
    word,  ///< one of `words`
    date,
    list,     ///< items like forms[0]
    entries,  ///< a table whose keys the user chooses, with values like forms[0]
    table,    ///< a table with `keys`
    either,   ///< one of `forms`
  };

  Kind kind = Kind::text;
  std::vector<std::string> units{};  ///< SI; several if the choice depends on the rig; empty: any
                                     ///< unit
  double lower = -std::numeric_limits<double>::infinity();  ///< smallest number
  double upper = std::numeric_limits<double>::infinity();   ///< largest number
  bool above_lower = false;                                 ///< `lower` itself is refused
  bool below_upper = false;                                 ///< `upper` itself is refused
  std::vector<std::string> words{};
  std::vector<KeyForm> forms;
  std::size_t least = 0;  ///< fewest items in a list
  std::size_t most = 0;   ///< most items in a list; 0: any number
  std::vector<CampaignKey> keys;
  std::string name{};  ///< type as shown in the documents; empty: the name of `kind`
};

/// One row of a table of keys: everything that the program knows about a key in a campaign file.
struct CampaignKey {
  std::string key;
  KeyForm form;
  std::string doc;          ///< meaning, in Markdown
  std::string standard{};   ///< default as TOML
  std::string otherwise{};  ///< default in words, if it is not a value
  bool needed = false;
  std::string example{};  ///< a value as TOML
  std::string hint{};     ///< comment in the draft of a campaign
};

/// Describes a quantity, or a plain number if the unit is "1".
KeyForm quantity_form(std::string_view unit);
/// @param units  SI; the rig determines which of them applies
KeyForm quantity_form(std::vector<std::string> units);
KeyForm number_form(QuantityRange range);
KeyForm whole_form(double lower, double upper);
KeyForm plain_form(KeyForm::Kind kind, std::string name = {});
KeyForm word_form(std::vector<std::string> words);
KeyForm list_form(KeyForm item, std::string name = "list", std::size_t least = 1,
                  std::size_t most = 0);
KeyForm entries_form(KeyForm value, std::string name = "table");
KeyForm table_form(std::vector<CampaignKey> keys);
KeyForm either_form(std::vector<KeyForm> forms, std::string name);

/// Returns the type as shown in the documents.
std::string type_name(const KeyForm& form);

std::vector<std::string> names_of(const std::vector<CampaignKey>& keys);

/// Returns the row for a key; null if there is none.
const CampaignKey* find_key(const std::vector<CampaignKey>& keys, std::string_view key);

}  // namespace rigcal::datasets
