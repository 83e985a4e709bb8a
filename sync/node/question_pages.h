// Writes QUESTION in pages that fit a datagram, and reassembles them. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/question_t.hpp>
#include <tuple>
#include <vector>

#include "sync/bus/page_assembler.h"

namespace tactus::sync {

// The question in pages of at most channels::kMaxMessageBytes, in order; one page if it fits. Precondition: valid(whole).
std::vector<question_t> question_pages(const question_t& whole);

// Reassembles pages into whole questions. Every repetition of a question has the same pages, so a page that was lost comes with a
// later repetition.
class QuestionReader {
 public:
  QuestionReader();
  // The whole question as one page, when this page completes it and the whole is valid; its header is that of the newest page. A
  // question of one page is returned as it is.
  std::optional<question_t> push(const question_t& page);
  void clear() { pages_.clear(); }

 private:
  using Key = std::tuple<std::int32_t, std::int64_t, std::int64_t>;  // source, incarnation and id of the question
  PageAssembler<question_t, Key> pages_;
};

}  // namespace tactus::sync
