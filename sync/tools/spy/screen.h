// The terminal display of a bus: a table of its channels, the fields of one, or the tagged variables; and the key commands.
// Pure: the program passes in received messages and typed bytes, and prints the lines.
#pragma once

#include <map>
#include <string>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <vector>

#include "sync/tools/spy/channels.h"
#include "sync/tools/spy/spark.h"
#include "sync/node/tag_table.h"

namespace tactus::sync::spy {

enum class Key { kNone, kUp, kDown, kPageUp, kPageDown, kEnter, kBack, kTags, kPause, kQuit };

// Parses the bytes from a terminal into keys, in order; an incomplete escape sequence stays in `bytes`.
std::vector<Key> take_keys(std::string& bytes);

class Screen {
 public:
  // A graph has one column each quarter of a second.
  static constexpr Nanoseconds kColumn{250'000'000};
  static constexpr std::size_t kMaxTags = 4096;

  void press(Key key);
  bool over() const { return over_; }
  bool paused() const { return paused_; }
  // Variables are on the screen: only then the program needs to request them.
  bool shows_tags() const { return page_ == Page::kTags; }

  // Samples the value of the marked field for its graph.
  void sample(const Channels& channels, HostTime now);
  void push(const tag_list_t& m) { table_.push(m); }
  void push(const tag_values_t& m, HostTime arrival);

  // The whole screen, `rows` lines of at most `columns` letters each; the marked line is number `marked()`.
  std::vector<std::string> draw(const Channels& channels, HostTime now, std::size_t columns, std::size_t rows);
  std::size_t marked() const { return marked_row_; }

 private:
  enum class Page { kChannels, kFields, kTags };
  struct Row {
    std::string name;  // identifies the row of the cursor while others appear and disappear
    std::string text;
  };
  struct Variable {
    std::string unit;
    double value = 0;
    Spark spark{kColumn};
  };
  std::vector<Row> channel_rows(const Channels& channels, HostTime now, std::size_t columns) const;
  std::vector<Row> field_rows(const Channels& channels, HostTime now, std::size_t columns) const;
  std::vector<Row> tag_rows(HostTime now, std::size_t columns) const;
  void move(const std::vector<Row>& rows, std::size_t visible);

  Page page_ = Page::kChannels;
  bool over_ = false, paused_ = false;
  int pending_move_ = 0;  // pending movement of the cursor, lines
  std::string marked_name_, channel_, channel_before_;
  std::size_t cursor_ = 0, top_ = 0, marked_row_ = 0;
  std::string graphed_path_;  // path of the marked field
  Spark graph_{kColumn};
  TagTable table_;
  std::map<std::string, Variable> tags_;
};

}  // namespace tactus::sync::spy
