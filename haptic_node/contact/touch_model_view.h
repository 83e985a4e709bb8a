// A whole touch model as it arrived: the planes and books of all its pages, in their order. Nothing is copied. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <tactus/header_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

namespace tactus::haptic {

class TouchModelView {
 public:
  static constexpr std::size_t kMaxPages = 16;  // design: twice what a tool has, 49 planes of 7 a page

  TouchModelView() = default;  // of none
  TouchModelView(const touch_model_t* whole) : pages_{whole}, count_(whole ? 1 : 0) {}
  TouchModelView(const touch_model_t& whole) : TouchModelView(&whole) {}

  // One page more, which outlives the view; beyond kMaxPages it is left out.
  void add(const touch_model_t& page) {
    if (count_ < kMaxPages) pages_[count_++] = &page;
  }
  explicit operator bool() const { return count_ > 0; }

  // The rest needs a model.
  const header_t& header() const { return pages_[0]->header; }
  std::size_t plane_count() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += pages_[i]->planes.size();
    return sum;
  }
  // i < plane_count().
  const touch_plane_t& plane(std::size_t i) const {
    std::size_t page = 0;
    for (; i >= pages_[page]->planes.size(); ++page) i -= pages_[page]->planes.size();
    return pages_[page]->planes[i];
  }
  template <class Use>
  void each_book(Use use) const {
    for (std::size_t i = 0; i < count_; ++i)
      for (const touch_applied_t& book : pages_[i]->applied) use(book);
  }

 private:
  std::array<const touch_model_t*, kMaxPages> pages_{};
  std::size_t count_ = 0;
};

}  // namespace tactus::haptic
