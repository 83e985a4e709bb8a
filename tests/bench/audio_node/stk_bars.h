// Struck bars of STK with four modes each, as a reference: as many bars as the given number of modes needs.
#pragma once

#include <stk/ModalBar.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

class StkBars {
 public:
  StkBars(int modes, double rate_Hz) {
    // The mallet sound that Debian's library lacks: 256 samples of 16 bits. Its content does not affect the cost.
    char folder[] = "/tmp/tactus-stk-XXXXXX";
    if (!mkdtemp(folder)) throw std::runtime_error("ring_bench: cannot make a folder in /tmp");
    {
      std::ofstream mallet(std::filesystem::path(folder) / "marmstk1.raw", std::ios::binary);
      for (int i = 0; i < 256; ++i) mallet.put(static_cast<char>(i % 7)), mallet.put(static_cast<char>(255 - i));
    }
    stk::Stk::setSampleRate(rate_Hz);
    stk::Stk::setRawwavePath(folder);
    bars_.resize(static_cast<std::size_t>(modes / 4));
    for (std::size_t i = 0; i < bars_.size(); ++i) bars_[i].setFrequency(100 + 20.0 * static_cast<double>(i));
    strike();
    std::filesystem::remove_all(folder);
  }

  double block(int frames, bool struck) {
    if (struck) strike();
    double sum = 0;
    for (int n = 0; n < frames; ++n)
      for (stk::ModalBar& bar : bars_) sum += bar.tick();
    return sum;
  }

 private:
  void strike() {
    for (stk::ModalBar& bar : bars_) bar.strike(0.5);
  }

  std::vector<stk::ModalBar> bars_;
};
