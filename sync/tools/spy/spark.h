// A graph of a number's history in a line of text. Pure; bounded.
#pragma once

#include <deque>
#include <string>

#include "sync/time/time.h"

namespace tactus::sync::spy {

class Spark {
 public:
  static constexpr std::size_t kMax = 240;  // columns of the widest supported terminal

  // each: the time of one column, which shows its last value.
  explicit Spark(Nanoseconds each) : each_(each) {}

  void add(double value, HostTime at);
  // The newest columns until now, at most the given number, scaled from their lowest to their highest value: " ▁▂▃▄▅▆▇█";
  // blank for a column without a value. UTF-8.
  struct Drawn {
    std::string text;
    double lowest = 0, highest = 0;
  };
  Drawn draw(HostTime now, std::size_t columns) const;

 private:
  struct Column {
    std::int64_t number;
    double value;
  };
  std::int64_t number(HostTime t) const { return t.time_since_epoch() / each_; }

  Nanoseconds each_;
  std::deque<Column> columns_;
};

}  // namespace tactus::sync::spy
