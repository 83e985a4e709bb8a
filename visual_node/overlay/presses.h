// What keys and the buttons of a gamepad mean to a question. Pure.
#pragma once

#include <optional>

#include "visual_node/devices/gamepad.h"

namespace tactus::visual {

// One press may mean several things; the question that is asked says which of them counts.
struct Press {
  int choice = -1;           // from 0; -1: none
  int fine = 0, coarse = 0;  // the mark of a number: -1 down, 1 up
  bool confirms = false;     // takes the number where its mark is
  bool goes_on = false;      // what was to be read has been read
  bool operator==(const Press&) const = default;
};

// key: as overlay/keys.h has them. Nothing: it has no meaning to any question.
std::optional<Press> press_of(int key);
Press press_of(Button button);

}  // namespace tactus::visual
