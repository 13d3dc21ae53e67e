#include "datasets/read/xlsx/xlsx_xml.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <type_traits>

#include "common/error.hpp"

namespace rigcal::datasets {
namespace {

/// Limit for a tag or comment. Expat rereads an unfinished one from its beginning for every block,
/// so one of 64 MB would take 20 s.
constexpr std::int64_t kMostTagBytes = std::int64_t{1} << 20;

// Expat 2.9 and later have 64-bit versions of these functions; Expat 2.5 does not.
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
std::uint64_t current_line(XML_Parser parser) { return XML_GetCurrentLineNumber64(parser); }
std::int64_t current_byte(XML_Parser parser) { return XML_GetCurrentByteIndex64(parser); }
#else
std::uint64_t current_line(XML_Parser parser) { return XML_GetCurrentLineNumber(parser); }
std::int64_t current_byte(XML_Parser parser) { return XML_GetCurrentByteIndex(parser); }
#endif

/// Separates the namespace from the name in the strings that Expat passes.
constexpr char kBehindNamespace = '|';

std::string_view without_namespace(std::string_view name) {
  const std::size_t end = name.rfind(kBehindNamespace);
  return end == std::string_view::npos ? name : name.substr(end + 1);
}

std::string_view namespace_of(std::string_view name) {
  const std::size_t end = name.rfind(kBehindNamespace);
  return end == std::string_view::npos ? std::string_view() : name.substr(0, end);
}

/// Callbacks for Expat. Exceptions are kept here until Expat has returned.
struct Listener {
  XML_Parser parser = nullptr;
  XmlHandler* handler = nullptr;
  std::exception_ptr error;
  bool has_document_type = false;
  std::optional<std::string> own_namespace{};  ///< namespace of the part's outermost element
  int foreign_depth = 0;  ///< number of open elements, from the first in another namespace

  template <typename Call>
  void guarded(Call call) {
    if (error) return;
    try {
      call();
    } catch (...) {  // rethrown by read_xml()
      error = std::current_exception();
      XML_StopParser(parser, XML_FALSE);
    }
  }

  static Listener& of(void* user) { return *static_cast<Listener*>(user); }
  static void start(void* user, const char* name, const char** attributes) {
    Listener& self = of(user);
    self.guarded([&] {
      const std::string_view space = namespace_of(name);
      if (!self.own_namespace) self.own_namespace = space;
      const bool is_foreign = self.foreign_depth > 0 || space != *self.own_namespace;
      if (!is_foreign)
        return self.handler->start(without_namespace(name), XmlAttributes(attributes));
      if (++self.foreign_depth == 1) self.handler->foreign();
    });
  }
  static void end(void* user, const char* name) {
    Listener& self = of(user);
    self.guarded([&] {
      if (self.foreign_depth > 0)
        --self.foreign_depth;
      else
        self.handler->end(without_namespace(name));
    });
  }
  static void text(void* user, const char* text, int length) {
    Listener& self = of(user);
    if (self.foreign_depth > 0) return;
    self.guarded(
        [&] { self.handler->text(std::string_view(text, static_cast<std::size_t>(length))); });
  }
  static void document_type(void* user, const char* /*name*/, const char* /*system*/,
                            const char* /*identity*/, int /*has_subset*/) {
    Listener& self = of(user);
    self.has_document_type = true;
    XML_StopParser(self.parser, XML_FALSE);
  }
};

struct FreeParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

}  // namespace

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const {
  std::optional<std::string_view> qualified;  // "r:id"
  for (const char** pair = pairs_; *pair != nullptr; pair += 2) {
    if (pair[0] == name) return std::string_view(pair[1]);
    if (!qualified && without_namespace(pair[0]) == name) qualified = pair[1];
  }
  return qualified;
}

void read_xml(const XlsxArchive& archive, const std::string& part, std::uint64_t most_bytes,
              XmlHandler& handler) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeParser> parser(
      XML_ParserCreateNS(nullptr, kBehindNamespace));
  if (!parser) throw std::bad_alloc();
  Listener listener{parser.get(), &handler, nullptr, false, {}, 0};
  XML_SetUserData(parser.get(), &listener);
  XML_SetElementHandler(parser.get(), Listener::start, Listener::end);
  XML_SetCharacterDataHandler(parser.get(), Listener::text);
  XML_SetStartDoctypeDeclHandler(parser.get(), Listener::document_type);
  const auto parse = [&](std::string_view block, bool is_last) {
    const XML_Status status =
        XML_Parse(parser.get(), block.data(), static_cast<int>(block.size()), is_last ? 1 : 0);
    if (listener.error) std::rethrow_exception(listener.error);
    if (listener.has_document_type)
      throw InputError({archive.name()},
                       fmt::format("its part '{}' has a document type declaration, which workbooks "
                                   "do not have; save it again as .xlsx",
                                   part));
    if (status == XML_STATUS_OK) return;
    if (XML_GetErrorCode(parser.get()) == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
    throw InputError({archive.name()},
                     fmt::format("is damaged in line {} of its part '{}' ({}); save it again as "
                                 ".xlsx",
                                 current_line(parser.get()), part,
                                 XML_ErrorString(XML_GetErrorCode(parser.get()))));
  };
  std::int64_t given = 0, begin = 0;
  archive.read(part, most_bytes, [&](std::string_view block) {
    parse(block, false);
    given += static_cast<std::int64_t>(block.size());
    // The position is -1 before the first token, and while Expat (2.6 and later) waits for the rest
    // of a token.
    if (const std::int64_t now = current_byte(parser.get()); now >= 0) begin = now;
    if (given - begin > kMostTagBytes)
      throw InputError({archive.name()},
                       fmt::format("its part '{}' has a tag or comment of more than {} MB; save it "
                                   "again as .xlsx",
                                   part, kMostTagBytes >> 20));
    return !handler.is_done();
  });
  if (!handler.is_done()) parse({}, true);
}

}  // namespace rigcal::datasets
