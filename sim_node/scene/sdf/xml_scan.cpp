#include "sim_node/scene/sdf/xml_scan.h"

#include <algorithm>
#include <utility>

namespace tactus::sim::sdf {
namespace {

constexpr std::pair<std::string_view, std::string_view> kSkipped[] = {
    {"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}};

// The end of a comment or the like that begins at `at`; `at` itself when an element begins there.
std::size_t skipped(std::string_view text, std::size_t at) {
  for (const auto& [begin, end] : kSkipped)
    if (text.substr(at).starts_with(begin)) {
      const auto found = text.find(end, at + begin.size());
      return found == std::string_view::npos ? text.size() : found + end.size();
    }
  return at;
}

}  // namespace

XmlCount count_xml(std::string_view text) {
  XmlCount count;
  std::size_t at = text.find('<'), worst = 0;
  while (at < text.size()) {
    if (const std::size_t end = skipped(text, at); end != at) {
      ++count.parts;
      at = text.find('<', end);
      continue;
    }
    const std::size_t begin = at;
    std::size_t attributes = 0;
    // To the end of the tag; each pair of quotes is an attribute.
    while ((at = text.find_first_of("\"'>", at)) < text.size() && text[at] != '>') {
      at = text.find(text[at], at + 1);
      if (at == std::string_view::npos) break;
      ++at, ++attributes;
    }
    count.parts += 1 + attributes;
    if (attributes > count.max_attributes) count.max_attributes = attributes, worst = begin;
    at = at < text.size() ? text.find('<', at) : at;
  }
  count.line += static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(worst), '\n'));
  return count;
}

std::string_view other_encoding(std::string_view text) {
  using namespace std::string_view_literals;
  // Byte order marks, and "<" without one (XML 1.0, appendix F); the longer ones first.
  for (const std::string_view begin : {"\xFF\xFE\0\0"sv, "\0\0\xFE\xFF"sv, "<\0\0\0"sv, "\0\0\0<"sv})
    if (text.starts_with(begin)) return "UTF-32";
  for (const std::string_view begin : {"\xFF\xFE"sv, "\xFE\xFF"sv, "<\0"sv, "\0<"sv})
    if (text.starts_with(begin)) return "UTF-16";
  return {};
}

}  // namespace tactus::sim::sdf
