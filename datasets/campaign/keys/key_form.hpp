#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {

struct CampaignKey;

/// The values that a key of a campaign file takes. Schema and documents are made from it.
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
  std::vector<std::string> units{};  ///< SI; several where the rig decides, none: any unit
  double lower = -std::numeric_limits<double>::infinity();  ///< least number
  double upper = std::numeric_limits<double>::infinity();   ///< greatest number
  bool above_lower = false;                                 ///< `lower` itself is refused
  bool below_upper = false;                                 ///< `upper` itself is refused
  std::vector<std::string> words{};
  std::vector<KeyForm> forms;
  std::size_t least = 0;  ///< items of a list
  std::size_t most = 0;   ///< 0: any number of items
  std::vector<CampaignKey> keys;
  std::string name{};  ///< type in the documents; empty: that of the kind
};

/// A row: all that the program knows about one key of a campaign file.
struct CampaignKey {
  std::string key;
  KeyForm form;
  std::string doc;          ///< meaning, in Markdown
  std::string standard{};   ///< default as TOML
  std::string otherwise{};  ///< what counts where the key is absent, in words, if it is no value
  bool needed = false;
  std::string example{};  ///< a value as TOML
  std::string hint{};     ///< comment in the draft of a campaign
};

/// A quantity, or a plain number where the unit is "1".
KeyForm quantity_form(std::string_view unit);
/// @param units  SI; the rig decides which of them
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

/// Type of a key in the documents.
std::string type_name(const KeyForm& form);

std::vector<std::string> names_of(const std::vector<CampaignKey>& keys);

/// The row of a key; null if there is none.
const CampaignKey* find_key(const std::vector<CampaignKey>& keys, std::string_view key);

}  // namespace rigcal::datasets
