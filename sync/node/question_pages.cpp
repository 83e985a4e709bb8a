#include "sync/node/question_pages.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "lcmtypes/channels.h"
#include "lcmtypes/page_limits.h"
#include "lcmtypes/utf8.h"
#include "lcmtypes/valid.h"

namespace tactus::sync {
namespace {

// Bytes that a page can still take.
std::size_t room_of(const question_t& page) {
  return channels::kMaxMessageBytes - std::min(channels::kMaxMessageBytes, static_cast<std::size_t>(page.getEncodedSize()));
}

}  // namespace

std::vector<question_t> question_pages(const question_t& whole) {
  question_t first = whole;
  first.page = 0, first.pages = 1;
  if (first.getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes)) return {first};
  constexpr std::size_t kTextBytes = 5;  // of an empty text: its length and the final zero
  first.text.clear(), first.choices.clear(), first.count = 0;
  question_t next = first;
  next.condition.clear(), next.progress.clear(), next.hint.clear();
  std::vector<question_t> pages{first};
  for (std::string_view left = whole.text; !left.empty();) {
    pages.back().text = first_bytes(left, room_of(pages.back()));
    left.remove_prefix(pages.back().text.size());
    if (!left.empty()) pages.push_back(next);
  }
  for (const std::string& choice : whole.choices) {
    if (choice.size() + kTextBytes > room_of(pages.back())) pages.push_back(next);
    pages.back().choices.push_back(choice);
    pages.back().count = static_cast<std::int32_t>(pages.back().choices.size());
  }
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i].page = static_cast<std::int32_t>(i);
    pages[i].pages = static_cast<std::int32_t>(pages.size());
  }
  return pages;
}

QuestionReader::QuestionReader() : pages_({.groups = 2, .pages = kMaxQuestionPages}, PageOrder::kNewestPage) {}

std::optional<question_t> QuestionReader::push(const question_t& page) {
  if (page.pages <= 1) return page;
  const auto* group = pages_.add({page.header.source, page.header.incarnation, page.id}, page.page, page.pages, page);
  if (!group) return std::nullopt;
  question_t whole = *group->pages.find(0);
  whole.page = 0, whole.pages = 1;
  for (const auto& [number, part] : group->pages) {
    if (part.header.seq > whole.header.seq) whole.header = part.header;
    if (number == 0) continue;
    whole.text += part.text;
    whole.choices.insert(whole.choices.end(), part.choices.begin(), part.choices.end());
  }
  whole.count = static_cast<std::int32_t>(whole.choices.size());
  return valid(whole) ? std::optional(whole) : std::nullopt;
}

}  // namespace tactus::sync
