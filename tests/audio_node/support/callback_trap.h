// Counts operations of a thread that the callback of a sound card must not perform: allocate, lock, wait, read or
// write. The executable that links callback_trap.cpp intercepts those calls, also from libraries, and passes them
// on.
#pragma once

#include <string>

namespace tactus::audio::test {

// Operations of this thread are counted while an instance exists.
class Trap {
 public:
  Trap();
  ~Trap();
  Trap(const Trap&) = delete;
  Trap& operator=(const Trap&) = delete;
};

// Count over all threads so far.
int trapped();
// The first counted call; empty: none.
std::string first_trapped();
void reset_trapped();

// False where a sanitizer intercepts the allocator itself.
bool traps_allocation();

}  // namespace tactus::audio::test
