// Pages of touch models on a network that loses, repeats and reorders them: only complete models come out, and
// never a mixture of two steps.
#include "haptic_node/contact/touch_pages.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/contact/touch_input.h"
#include "sync/bus/decode.h"
#include "tests/haptic_node/support/paged_models.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

TEST_CASE("Every page of a touch model fits a datagram, and all pages together form the model") {
  std::int64_t seq = 3;
  for (const std::size_t planes : {0u, 1u, 7u, 8u, 49u})
    for (const std::size_t applied_count : {0u, 7u, 14u}) {
      const touch_model_t whole = whole_model(9, planes, applied_count);
      TouchPages assembler;
      TouchModelView out;
      for (const touch_model_t& page : pages_of(whole, seq)) {
        CHECK(sync::encode(page).size() <= 1400);
        CHECK_FALSE(out);
        out = assembler.add(page);
      }
      REQUIRE(out);
      CHECK(is_whole(out, 9, planes, applied_count));
    }
}

TEST_CASE("Loss, repetition and reordering of pages yield each complete model once and no other model") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::uniform_real_distribution<>(0, 1)(random) < p; };
    const double loss = 0.1 * (seed % 4), twice = 0.1 * (seed % 3);
    std::vector<std::size_t> planes;
    struct Sent {
      std::int64_t step;
      touch_model_t page;
    };
    std::vector<Sent> wire;
    std::int64_t seq = 0;
    std::vector<bool> complete;
    for (std::int64_t step = 0; step < 40; ++step) {
      planes.push_back(random() % 50);
      bool all = true;
      for (const touch_model_t& page : pages_of(whole_model(step, planes.back(), 3), seq)) {
        if (chance(loss)) {
          all = false;
          continue;
        }
        wire.push_back({step, page});
        if (chance(twice)) wire.push_back({step, page});
      }
      complete.push_back(all);
    }
    // Neighbouring pages overtake each other, by little more than a step.
    for (int round = 0; round < 5; ++round)
      for (std::size_t i = 0; i + 1 < wire.size(); ++i)
        if (chance(0.3)) std::swap(wire[i], wire[i + 1]);
    TouchPages assembler;
    std::vector<int> received(40, 0);
    for (const Sent& s : wire) {
      const TouchModelView out = assembler.add(s.page);
      if (!out) continue;
      const std::int64_t step = out.header().sim_time_ns / kMs;
      REQUIRE(is_whole(out, step, planes[static_cast<std::size_t>(step)], 3));
      ++received[static_cast<std::size_t>(step)];
    }
    for (std::size_t step = 0; step < 40; ++step) {
      CAPTURE(seed, step, planes[step]);
      if (complete[step])
        CHECK(received[step] >= 1);
      else
        CHECK(received[step] == 0);
      if (planes[step] > 7) CHECK(received[step] <= 1);
    }
  }
}

TEST_CASE("Pages of two models of the same instant are not mixed while the simulation is paused") {
  std::int64_t seq = 0;
  touch_model_t first = whole_model(7, 20, 0), second = whole_model(7, 20, 0);
  for (touch_plane_t& p : second.planes) p.body = 1;
  auto a = pages_of(first, seq), b = pages_of(second, seq);
  TouchPages assembler;
  CHECK_FALSE(assembler.add(a[0]));
  CHECK_FALSE(assembler.add(b[1]));
  CHECK_FALSE(assembler.add(b[2]));
  const TouchModelView out = assembler.add(b[0]);
  REQUIRE(out);
  for (std::size_t i = 0; i < out.plane_count(); ++i) CHECK(out.plane(i).body == 1);
}

TEST_CASE("An older model that becomes complete after a newer model is ignored") {
  std::int64_t seq = 0;
  const auto old_pages = pages_of(whole_model(1, 20, 0), seq), new_pages = pages_of(whole_model(2, 20, 0), seq);
  TouchInput input(0, 1);
  const auto now = sync::host_time(2 * kMs);
  input.push(old_pages[0], now);
  input.push(old_pages[1], now);
  for (const touch_model_t& page : new_pages) input.push(page, now);
  const TouchModelView taken = input.pop();
  REQUIRE(taken);
  CHECK(taken.header().sim_time_ns == 2 * kMs);
  input.push(old_pages[2], now);
  CHECK_FALSE(input.pop());
}

TEST_CASE("A page that never arrives counts as a loss even when other pages arrive") {
  TouchInput input(0, 1);
  std::int64_t seq = 0;
  for (const touch_model_t& page : pages_of(whole_model(1, 20, 0), seq)) input.push(page, sync::host_time(kMs));
  CHECK_FALSE(input.unfinished_since());
  for (std::int64_t step = 2; step < 100; ++step) {
    const auto pages = pages_of(whole_model(step, 20, 0), seq);
    input.push(pages[0], sync::host_time(step * kMs));
    input.push(pages[2], sync::host_time(step * kMs));
  }
  CHECK(input.arrival() == sync::host_time(kMs));
  REQUIRE(input.unfinished_since());
  CHECK(*input.unfinished_since() == sync::host_time(2 * kMs));
  for (const touch_model_t& page : pages_of(whole_model(100, 20, 0), seq))
    input.push(page, sync::host_time(100 * kMs));
  CHECK_FALSE(input.unfinished_since());
}
