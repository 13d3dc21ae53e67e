#include <memory>
#include <optional>
#include <string>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"

namespace rigcal::app {
namespace {

struct SchemaRequest {
  std::string what;
  std::optional<std::string> table;
  PrintOptions print;
};

ExitCode run_schema(const SchemaRequest& request) {
  const std::string schema = datasets::campaign_schema();
  if (!request.table) {
    print(request.print, schema, schema);
    return ExitCode::done;
  }
  const auto* keys = datasets::find_campaign_table(*request.table);
  if (keys == nullptr)
    throw UsageError("--table " + *request.table +
                     ": no such table; expected the path of one, such as fit or "
                     "recording.channels.position");
  print(request.print, datasets::markdown_of(*keys), schema);
  return ExitCode::done;
}

}  // namespace

Run add_schema(CLI::App& verb) {
  const auto request = std::make_shared<SchemaRequest>();
  verb.add_option("WHAT", request->what, "Kind of file: campaign")
      ->required()
      ->check(CLI::IsMember({"campaign"}));
  verb.add_option(
      "--table", request->table,
      "Keys of this table as Markdown, such as fit or recording.channels.position; empty: of "
      "the whole file");
  add_print_options(verb, request->print);
  return [request](const Invocation&) { return run_schema(*request); };
}

}  // namespace rigcal::app
