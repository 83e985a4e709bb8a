// Connects the messages and the pages: passes messages to the watches of each page, and sends changes in frames. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/live/answers.h"
#include "scripts/live/feed.h"
#include "scripts/live/watches.h"
#include "sync/tools/picture_reader.h"
#include "sync/node/tag_table.h"
#include "sync/time/time.h"

namespace tactus::live {

class PageSession {
 public:
  static constexpr sync::Nanoseconds kFramePeriod{50'000'000};  // design: 20 frames per second look smooth

  // live: false when a log is shown. run_id: as of Feed.
  PageSession(bool live, std::int64_t run_id, std::string title);

  void open(int page) { watches_[page]; }
  void close(int page) { watches_.erase(page); }
  // Sets the variables that one page shows from now on. Returns a sentence about invalid names; "": all are valid.
  std::string watch(int page, const std::vector<std::string>& names) { return watches_[page].set(names); }

  bool accepts(std::string_view channel) const;
  void on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // Call it when the log position has changed.
  void clear();

  // The first message to a page.
  std::string hello(sync::HostTime now) const;
  // The frame of each page; extra: members that all frames get.
  std::map<int, std::string> frames(sync::HostTime now, const nlohmann::json& extra);
  // The newest picture that has not been taken yet, as JPEG.
  std::optional<std::string> picture();
  double picture_aspect() const { return aspect_; }
  // The arrival of the newest picture.
  std::optional<sync::HostTime> picture_arrival() const { return picture_arrival_; }

  // The tagged variables that the pages show, as patterns of TAG_REQUEST.
  std::vector<std::string> requested_tags() const;
  // The current question of a study, and the answers of pages.
  Answers& answers() { return answers_; }

 private:
  nlohmann::json tag_list() const;
  nlohmann::json study(sync::HostTime now) const;

  bool live_;
  std::string title_;
  Feed feed_;
  Answers answers_;
  std::map<int, Watches> watches_;
  sync::TagTable tags_;
  std::size_t sent_tag_count_ = 0;
  sync::PictureReader pictures_;
  std::optional<std::int32_t> wall_;
  std::optional<std::string> picture_;
  double aspect_ = 4.0 / 3;
  std::optional<sync::HostTime> picture_arrival_;
};

}  // namespace tactus::live
