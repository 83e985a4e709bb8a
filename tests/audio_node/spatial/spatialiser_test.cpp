#include "audio_node/spatial/spatialiser.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "audio_node/spatial/air.h"
#include "audio_node/spatial/onset.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/kemar.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

struct StereoOutput {
  std::vector<double> left, right;
};

// A tone of amplitude 1 at place(block) at the end of each block.
template <class PlaceAt>
StereoOutput tone(const Space& space, double frequency_Hz, int blocks, PlaceAt place) {
  Spatialiser spatialiser(space, 1, kRate, available_instructions().back());
  spatialiser.begin(0);
  StereoOutput output;
  for (int b = 0; b < blocks; ++b) {
    std::vector<float> in, out(2 * kMaxBlock);
    for (int n = 0; n < kMaxBlock; ++n)
      in.push_back(
          static_cast<float>(std::sin(2 * std::numbers::pi * frequency_Hz * (b * kMaxBlock + n) / kRate)));
    spatialiser.add(0, place(b), in.data(), kMaxBlock);
    spatialiser.mix(out.data(), kMaxBlock);
    for (std::size_t n = 0; n < kMaxBlock; ++n) {
      output.left.push_back(static_cast<double>(out[2 * n]));
      output.right.push_back(static_cast<double>(out[2 * n + 1]));
    }
  }
  return output;
}

double largest(const std::vector<double>& x, std::size_t from) {
  double most = 0;
  for (std::size_t n = from; n < x.size(); ++n) most = std::max(most, std::abs(x[n]));
  return most;
}

double rms(const std::vector<double>& x, std::size_t from) {
  double sum = 0;
  for (std::size_t n = from; n < x.size(); ++n) sum += x[n] * x[n];
  return std::sqrt(sum / static_cast<double>(x.size() - from));
}

double largest_bend(const std::vector<double>& x, std::size_t from) {
  double most = 0;
  for (std::size_t n = from; n + 1 < x.size(); ++n)
    most = std::max(most, std::abs(x[n + 1] - 2 * x[n] + x[n - 1]));
  return most;
}

SourcePosition at(double azimuth_deg, float distance_m = 1) { return {towards(azimuth_deg), distance_m}; }

constexpr std::size_t kSettled = 256;  // longer than any filter and delay

}  // namespace

TEST_CASE("A source that circles the head once a second makes no click") {
  const Space space = GENERATE(Space{ears(), nullptr}, Space{},
                               Space{nullptr, std::make_shared<const Panning>(load_layout("stereo"))});
  const double f = 440, w = 2 * std::numbers::pi * f / kRate;
  const auto swept = tone(space, f, 750, [](int b) { return at(360.0 * b / 750); });
  double gain = 0;
  for (int azimuth = 0; azimuth < 360; azimuth += 5) {
    const auto still = tone(space, f, 12, [&](int) { return at(azimuth); });
    gain = std::max({gain, largest(still.left, kSettled), largest(still.right, kSettled)});
  }
  // The second difference of a tone is w^2 of its amplitude. Block borders add to it: in every second block the
  // delay changes by 4 pi 31 samples a second, 0.008 w, and gains change by at most 4 pi a second, 2.6e-4; both
  // together 0.22 w^2. A click of -50 dB would be one of w^2.
  CHECK(std::max(largest_bend(swept.left, kSettled), largest_bend(swept.right, kSettled)) < 1.25 * w * w * gain);
}

TEST_CASE("A source that jumps to the other side crossfades within a block") {
  const double f = 440, w = 2 * std::numbers::pi * f / kRate;
  const auto leapt = tone({ears(), nullptr}, f, 40, [](int b) { return at(b < 20 ? 90 : -90); });
  const double gain = std::max(largest(leapt.left, kSettled), largest(leapt.right, kSettled));
  // Within 64 samples the delay changes by 31, so the tone bends by (1 + 31/64)^2 w^2; at the beginning and the
  // end of that its slope jumps by 31/64 w, and the crossfade adds twice the gain over 64.
  CHECK(std::max(largest_bend(leapt.left, kSettled), largest_bend(leapt.right, kSettled)) <
        (2.2 * w * w + 0.5 * w + 2.0 / 64) * gain);
}

TEST_CASE("The next sound on a source starts without the filters and delays of the last one") {
  const Space space = GENERATE(Space{ears(), nullptr}, Space{});
  Spatialiser spatialiser(space, 1, kRate, Instructions::kSse2);
  std::vector<float> loud(kMaxBlock, 1.f), none(kMaxBlock), out(2 * kMaxBlock);
  spatialiser.begin(0);
  spatialiser.add(0, at(90, 20), loud.data(), kMaxBlock);
  spatialiser.mix(out.data(), kMaxBlock);
  spatialiser.begin(0);
  std::fill(out.begin(), out.end(), 0.f);
  for (int b = 0; b < 8; ++b)
    spatialiser.add(0, at(-90), none.data(), kMaxBlock), spatialiser.mix(out.data(), kMaxBlock);
  CHECK(std::all_of(out.begin(), out.end(), [](float x) { return x == 0; }));
}

TEST_CASE("After its tail a source is silent") {
  Spatialiser spatialiser({ears(), nullptr}, 1, kRate, Instructions::kSse2);
  spatialiser.begin(0);
  std::vector<float> in(kMaxBlock);
  in.back() = 1;
  std::vector<float> output;
  for (int b = 0; b < 8; ++b) {
    std::vector<float> out(2 * kMaxBlock);
    spatialiser.add(0, at(90), in.data(), kMaxBlock);
    spatialiser.mix(out.data(), kMaxBlock);
    in.assign(kMaxBlock, 0.f);
    output.insert(output.end(), out.begin(), out.end());
  }
  const auto after = output.begin() + 2 * (kMaxBlock + spatialiser.tail());
  CHECK(std::all_of(after, output.end(), [](float x) { return x == 0; }));
  // The far ear still has output in the last quarter.
  CHECK(std::any_of(after - spatialiser.tail() / 2, after, [](float x) { return x != 0; }));
}

TEST_CASE("The pressure falls with the distance, and the air absorbs high frequencies") {
  const double f = GENERATE(500.0, 8000.0);
  const float distance_m = GENERATE(0.5f, 2.f, 20.f);
  const auto near = tone({}, f, 60, [](int) { return at(0, 1); });
  const auto far = tone({}, f, 60, [&](int) { return at(0, distance_m); });
  const auto r = static_cast<double>(distance_m);
  const double air_dB = std::max(0.0, r - 1) * absorption_dB_m(f);
  const double expected = rms(near.left, 2000) / r * std::pow(10, -air_dB / 20);
  // The one-pole is exact at 8 kHz; at 500 Hz it attenuates by 1/256 of that instead of 1/40: 0.05 dB at 20 m.
  CHECK(rms(far.left, 2000) == Approx(expected).epsilon(0.006));
}

TEST_CASE("A ringing body stays in place while the listener turns") {
  Voices voices(4, kRate, kRing, {ears(), nullptr});
  Strike strike = strike_of(1, 1, 2000, 5, 0);
  SourcePosition& place = strike.sides[0].place;
  place.direction = Eigen::Vector3f::UnitY();
  place.source_m = 2 * Eigen::Vector3d::UnitY();
  place.distance_m = 2;
  voices.strike(strike.sides[0], 1, strike.pulse, 0);
  const auto louder_left = [&] {
    double left = 0, right = 0;
    for (int b = 0; b < 20; ++b) {
      std::vector<float> out(2 * kMaxBlock);
      voices.render(out.data(), kMaxBlock);
      for (std::size_t n = 0; b > 4 && n < kMaxBlock; ++n)
        left = std::max(left, std::abs(static_cast<double>(out[2 * n]))),
        right = std::max(right, std::abs(static_cast<double>(out[2 * n + 1])));
    }
    return 20 * std::log10(left / right);
  };
  CHECK(louder_left() > 6);
  Listener listener;
  listener.T_W_listener = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
  voices.set_listener(listener);
  CHECK(louder_left() < -6);
  listener.T_W_listener = Eigen::Translation3d(0, 4, 0) * listener.T_W_listener;  // it has walked past the source
  voices.set_listener(listener);
  CHECK(louder_left() > 6);
}

TEST_CASE("A voice that has ended leaves no state to the next one on its source") {
  const auto render = [](Voices& voices, int blocks) {
    std::vector<float> all;
    for (int b = 0; b < blocks; ++b) {
      std::vector<float> out(2 * kMaxBlock);
      voices.render(out.data(), kMaxBlock);
      all.insert(all.end(), out.begin(), out.end());
    }
    return all;
  };
  const Space space{ears(), nullptr};
  Voices used(1, kRate, kRing, space), fresh(1, kRate, kRing, space);
  const Strike first = strike_of(1, 1, 3000, 500, 0), second = strike_of(2, 2, 500, 500, 0);
  used.strike(first.sides[0], 1, first.pulse, 0);
  render(used, 200);
  REQUIRE(used.active() == 0);
  for (const float x : render(used, 10)) CHECK(x == 0);
  used.strike(second.sides[0], 1, second.pulse, 0);
  fresh.strike(second.sides[0], 1, second.pulse, 0);
  CHECK(render(used, 50) == render(fresh, 50));
}

namespace {

// The first audible sample, at the nearer ear, of a blow that is due on sample 960.
double first_heard_blow(const Space& space, const Eigen::Vector3f& from) {
  RendererDef def;
  def.space = space;
  CallbackQueues queues;
  Renderer renderer(queues, def);
  Strike strike = strike_of(1, 1, 6000, 3000, kStart_ns + 20'000'000);
  strike.sides[0].place.direction = from;
  REQUIRE(queues.strikes.push(strike));
  std::vector<float> both;
  for (std::int64_t frame = 0; frame < 2048; frame += kMaxBlock) {
    std::vector<float> out(2 * kMaxBlock);
    renderer.render(out.data(), kMaxBlock, {sync::host_time(kStart_ns + frame * 1'000'000'000 / 48000), {}, {}});
    for (std::size_t n = 0; n < kMaxBlock; ++n) both.push_back(out[2 * n] + out[2 * n + 1]);
  }
  return static_cast<double>(first_audible(both));
}

}  // namespace

TEST_CASE("The first audible sample of a blow from any side is on time, in the mean to 0.1 ms") {
  const Space by_ears{ears(), nullptr};
  double sum = 0, weights = 0;
  for (int elevation = -60; elevation <= 60; elevation += 30)
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
      CAPTURE(azimuth, elevation);
      const Eigen::Vector3f from = towards(azimuth, elevation);
      const double later = first_heard_blow(by_ears, from) - first_heard_blow({}, from);
      // Responses rise as fast as the pinna allows: 6 to 16 samples from the beginning of the filters to a
      // fiftieth of the peak, around a mean of 11; two more for the rise of the blow itself.
      CHECK(later >= -7);
      CHECK(later <= 7);
      const double weight = std::cos(elevation * std::numbers::pi / 180);
      sum += weight * later, weights += weight;
    }
  // A blow rises for half a period of its 6 kHz, 4 samples, and may be audible later than an impulse by that much.
  CHECK(std::abs(sum / weights) <= 4);
}

TEST_CASE("A source position that is not finite counts as straight ahead") {
  const Space space = GENERATE(Space{ears(), nullptr}, Space{},
                               Space{nullptr, std::make_shared<const Panning>(load_layout("stereo"))});
  const float none = GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
  const auto ahead = tone(space, 440, 4, [](int) { return at(0); });
  const bool direction = GENERATE(true, false);
  const auto output = tone(space, 440, 4, [&](int) {
    return direction ? SourcePosition{Eigen::Vector3f(none, 0, 0), 1} : SourcePosition{Eigen::Vector3f::UnitX(), none};
  });
  CHECK(output.left == ahead.left);
  CHECK(output.right == ahead.right);
}

namespace {

// A body that rings at 440 Hz without damping and is struck from the left, then from elsewhere.
struct Restruck {
  Voices voices;
  StereoOutput output;

  explicit Restruck(const Space& space) : voices(4, kRate, kRing, space, available_instructions().back()) {}
  void strike(const Eigen::Vector3f& from, float distance_m, float impulse) {
    StrikeSide side = strike_of(1, 1, 440, 0, 0, impulse).sides[0];
    side.place = {from, distance_m};
    side.place.source_m = (distance_m * from).cast<double>();
    voices.strike(side, 1, one_hump(1), 0);
  }
  void play(int blocks) {
    for (int b = 0; b < blocks; ++b) {
      std::vector<float> out(2 * kMaxBlock);
      voices.render(out.data(), kMaxBlock);
      for (std::size_t n = 0; n < kMaxBlock; ++n) {
        output.left.push_back(static_cast<double>(out[2 * n]));
        output.right.push_back(static_cast<double>(out[2 * n + 1]));
      }
    }
  }
  // Over the last 10 ms.
  double left_over_right() const {
    const std::size_t from = output.left.size() - 480;
    return largest(output.left, from) / largest(output.right, from);
  }
};

}  // namespace

TEST_CASE("A ringing body that is struck elsewhere moves there without a click") {
  const Space space = GENERATE(Space{ears(), nullptr}, Space{},
                               Space{nullptr, std::make_shared<const Panning>(load_layout("stereo"))});
  const bool in_world = GENERATE(false, true);
  const float distance_m = GENERATE(1.f, 3.f);
  Restruck body(space);
  if (in_world) body.voices.set_listener({});
  body.strike(towards(80), 1, 0.1f);
  body.play(20);
  CHECK(body.left_over_right() > 1.5);
  // A blow without strength, so that the only sound is the one that moves.
  body.strike(towards(-80), distance_m, 0);
  body.play(400);  // 0.53 s: half a revolution takes 0.5 s
  const double w = 2 * std::numbers::pi * 440 / kRate;
  const double gain = std::max(largest(body.output.left, kSettled), largest(body.output.right, kSettled));
  CHECK(std::max(largest_bend(body.output.left, kSettled), largest_bend(body.output.right, kSettled)) <
        (w * w + 1e-3) * gain);
  CHECK(body.left_over_right() < 1 / 1.5);
  Restruck there(space);
  there.strike(towards(-80), distance_m, 0.1f);
  there.play(400);
  // Over the last 10 ms, 4.4 periods, in which its phase may differ.
  CHECK(largest(body.output.right, 20 * kMaxBlock + 25120) ==
        Approx(largest(there.output.right, 25120)).epsilon(0.01));
}

TEST_CASE("A blow that masks the ringing sounds from its own place at once") {
  const Space space = GENERATE(Space{ears(), nullptr}, Space{});
  Restruck body(space);
  body.strike(towards(80), 1, 0.001f);
  body.play(20);
  body.strike(towards(-80), 1, 0.1f);
  body.play(8);  // 480 frames, plus the delay of the filters
  CHECK(body.left_over_right() < 1 / 1.5);
}
