// draw_text: draws text of any language in a confined process, for visual_node. Not for users: input and output
// are records (sync/sandbox/records.h). With --check it names the characters of its standard input that no
// installed font covers.
#include <fontconfig/fontconfig.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "lcmtypes/utf8.h"
#include "sync/sandbox/reader_program.h"
#include "visual_node/text/confined_text.h"
#include "visual_node/text/typeset/typesetter.h"

namespace {

using namespace tactus;

constexpr char kHelp[] =
    "Usage: draw_text [--check]\n\n"
    "Draws text of any language for visual_node, confined in a process of its own. Input and output are binary.\n"
    "  --check  read a text in UTF-8 from standard input, and print each of its characters that no installed font "
    "covers, as\n"
    "           U+HEX, one a line\n"
    "  --help   print this text\n";

constexpr std::size_t kMaxInputBytes = std::size_t{1} << 20;

// The folders of fonts, of their settings and of their caches.
std::vector<std::filesystem::path> font_folders() {
  std::vector<std::filesystem::path> folders{"/usr/share", "/usr/local/share", "/etc/fonts",
                                             "/var/cache/fontconfig"};
  FcInit();
  FcStrList* const all = FcConfigGetFontDirs(nullptr);
  while (const FcChar8* folder = all ? FcStrListNext(all) : nullptr)
    folders.emplace_back(reinterpret_cast<const char*>(folder));
  if (all) FcStrListDone(all);
  return folders;
}

// At most kMaxInputBytes + 1: a longer text is refused, and never read as a whole.
std::string read_text() {
  std::string text(kMaxInputBytes + 1, '\0');
  std::cin.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::cin.gcount()));
  return text;
}

// The text of a study is untrusted, so that a second, confined process of this program draws it.
int check() {
  const std::string input = read_text();
  std::string_view rest = input;
  if (rest.size() > kMaxInputBytes) throw std::runtime_error("the text has more than 1 MiB; give less");
  visual::ConfinedText text;
  std::set<char32_t> known;
  std::vector<char32_t> missing;
  while (!rest.empty()) {
    std::string_view piece = first_bytes(rest.substr(0, rest.find('\n')), visual::kMaxTextBytes);
    const visual::TextRequest request{
        {{std::string(piece), 32, visual::kMaxTextWidth_px, visual::TextEdge::kNatural}}, true};
    for (const char32_t c : text.draw(request).missing)
      if (known.insert(c).second) missing.push_back(c);
    rest.remove_prefix(
        std::min(rest.size(), piece.size() + (rest.size() > piece.size() && rest[piece.size()] == '\n')));
  }
  for (const char32_t c : missing) std::printf("U+%04X\n", static_cast<unsigned>(c));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--check") {
    try {
      return check();
    } catch (const std::exception& e) {
      std::fprintf(stderr, "draw_text: the text cannot be checked: %s\n", e.what());
      return 1;
    }
  }
  if (const auto status = sync::reader_options(argc, argv, kHelp)) return *status;
  if (argc != 1 || isatty(STDIN_FILENO)) {
    std::fprintf(stderr, "draw_text: visual_node starts this program; it takes no file\n");
    return 1;
  }
  std::optional<visual::Typesetter> typesetter;  // after the confinement, which its thread then has too
  return sync::reader_session_main(font_folders(), {.threads = true}, [&](std::span<const std::uint8_t> bytes) {
    const visual::TextRequest request = visual::unpack_text_request(bytes);
    if (!typesetter) typesetter.emplace();
    return visual::pack(typesetter->draw(request));
  });
}
