// A complete touch model: the planes and applied impulses of all its pages, in their order, without a copy. Pure.
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

  TouchModelView() = default;  // empty
  TouchModelView(const touch_model_t* whole) : pages_{whole}, count_(whole ? 1 : 0) {}
  TouchModelView(const touch_model_t& whole) : TouchModelView(&whole) {}

  // Adds a page, which outlives the view; ignored beyond kMaxPages.
  void add(const touch_model_t& page) {
    if (count_ < kMaxPages) pages_[count_++] = &page;
  }
  explicit operator bool() const { return count_ > 0; }

  // The following functions require a model.
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
  template <class Visit>
  void for_each_applied(Visit visit) const {
    for (std::size_t i = 0; i < count_; ++i)
      for (const touch_applied_t& applied : pages_[i]->applied) visit(applied);
  }

 private:
  std::array<const touch_model_t*, kMaxPages> pages_{};
  std::size_t count_ = 0;
};

}  // namespace tactus::haptic
