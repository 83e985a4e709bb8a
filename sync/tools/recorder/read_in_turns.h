// Reads several ports in turns, with an upper bound, so that a flood cannot hold the reader. Pure.
#pragma once

namespace tactus::sync {

// Reads at most `batch` messages of each port in turn, by read(port, batch), which returns their number. Ends when no port
// has a message left, or when at least `max_messages` were read. Returns the number of messages read.
template <class Ports, class Read>
int read_in_turns(Ports& ports, int batch, int max_messages, Read&& read) {
  int total = 0;
  for (bool more = true; more && total < max_messages;) {
    more = false;
    for (auto& port : ports) {
      const int count = read(port, batch);
      total += count;
      more |= count > 0;
    }
  }
  return total;
}

}  // namespace tactus::sync
