// Reassembles the pictures of a stream from their pieces (PICTURE_CHUNK). Pure. Bounded: only the newest picture of each
// source is assembled; an incomplete one is skipped when the next begins.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tactus/picture_chunk_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/page_assembler.h"

namespace tactus::sync {

struct StreamedPicture {
  std::int32_t source = 0;  // header.source: identifies the wall
  std::int64_t picture = 0;
  std::int64_t sim_time_ns = -1;
  std::int64_t presented_ns = -1;  // by the clock of its source
  int width = 0, height = 0;
  std::vector<std::uint8_t> jpeg;
};

class PictureReader {
 public:
  // 4 MiB a picture, and this number of walls. With more, the wall that has been silent for longest is removed.
  static constexpr int kMaxChunks = 4096;
  static constexpr std::size_t kMaxSources = 8;

  // Returns the picture that this piece completes.
  std::optional<StreamedPicture> push(const picture_chunk_t& m);
  // Number of pictures that began and were never completed.
  std::int64_t skipped() const { return skipped_; }

 private:
  struct Partial {
    std::int64_t incarnation = 0, picture = -1, last_message = 0;
    // Incomplete pictures by incarnation and number of the picture.
    PageAssembler<std::vector<std::uint8_t>, std::pair<std::int64_t, std::int64_t>> chunks{
        {.groups = 1, .pages = kMaxChunks, .remembered = 1}};
  };
  std::map<std::int32_t, Partial> partials_;
  std::int64_t skipped_ = 0, messages_ = 0;
};

}  // namespace tactus::sync
