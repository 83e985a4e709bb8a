#include "audio_node/scrapes.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {
namespace {

// A place that is told differs from where the last one has led: it is taken in within so long. Design: the hand
// and the world have ticks of 1 ms each and now and then slip by one.
constexpr double kFollow_s = 0.01;
// A level goes to the next within so long: two ticks of what is told. Design.
constexpr double kLevel_s = 0.002;
// A scrape that is not told of any more fades.
constexpr sync::Nanoseconds kSilence{30'000'000};  // design: a few lost messages are no gap
constexpr float kOver = 1e-6f;
// Of the roughness without a map: its grain, and how steep it is. Design: a planed board feels and sounds of a
// tenth of a millimetre.
constexpr double kGrain_m = 1e-4, kRough = 0.05;

// A number of -1 .. 1 for each grain (splitmix64's finaliser, Steele, Lea and Flood 2014).
double grain(std::int64_t i) {
  auto z = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>(static_cast<std::int64_t>((z ^ (z >> 31)) >> 11)) * 0x1p-52 - 1;
}

}  // namespace

double roughness(double travelled_m) {
  const double x = travelled_m / kGrain_m, whole = std::floor(x), part = x - whole;
  const auto i = static_cast<std::int64_t>(whole);
  // Linear between numbers of mean square 1/3, which takes a third more off it.
  constexpr double kToUnit = 2.1213203435596424;  // sqrt(3 * 3 / 2)
  return kToUnit * (grain(i) * (1 - part) + grain(i + 1) * part);
}

void Scrapes::take(const Scrape& scrape) {
  Voice* free = nullptr;
  for (Voice& v : voices_) {
    if (v.on && v.now.id == scrape.id) {
      v.now = scrape;
      v.heard = scrape.at;
      return;
    }
    if (!v.on && !free) free = &v;
  }
  if (!free) return;
  *free = Voice{};
  spatialiser_.begin(static_cast<int>(free - voices_.data()));
  free->on = true;
  free->now = scrape;
  free->heard = scrape.at;
  free->u = scrape.u, free->v = scrape.v, free->travelled_m = scrape.travelled_m;
}

void Scrapes::render(Voice& voice, int frames, sync::HostTime first) {
  const Scrape& s = voice.now;
  const double dt = 1 / rate_Hz_;
  // Where what was told would be at the first of these samples; what is missing is made up on the way.
  const double since_s = sync::to_seconds(first - s.at);
  const double lag_u = s.u + s.u_per_s * since_s - voice.u, lag_v = s.v + s.v_per_s * since_s - voice.v;
  const double lag_m = s.travelled_m + s.speed_m_s * since_s - voice.travelled_m;
  const double step_u = (s.u_per_s + lag_u / kFollow_s) * dt, step_v = (s.v_per_s + lag_v / kFollow_s) * dt;
  const double step_m = (s.speed_m_s + lag_m / kFollow_s) * dt;
  std::array<float, kMaxBlock> out;
  const bool told = first - voice.heard < kSilence;
  const float wanted = told ? s.level : 0, follow = static_cast<float>(1 - std::exp(-dt / kLevel_s));
  for (int n = 0; n < frames; ++n) {
    double slope = kRough * roughness(voice.travelled_m);
    if (s.relief) slope += s.relief->slope({voice.u, voice.v}).dot(Eigen::Vector2d(s.along_u, s.along_v));
    voice.level += follow * (wanted - voice.level);
    out[static_cast<std::size_t>(n)] = voice.level * static_cast<float>(slope);
    voice.u += step_u, voice.v += step_v, voice.travelled_m += step_m;
  }
  spatialiser_.add(static_cast<int>(&voice - voices_.data()), listener_ ? heard_by(*listener_, s.place) : s.place,
                   out.data(), frames);
  // The comparison also ends one that has become no number.
  const bool over = !told && !(voice.level > kOver);
  if (over && voice.silent >= spatialiser_.tail()) voice.on = false;
  voice.silent = over ? voice.silent + frames : 0;
}

void Scrapes::render(float* mix, int frames, sync::HostTime first) {
  for (Voice& v : voices_)
    if (v.on) render(v, frames, first);
  spatialiser_.mix(mix, frames);
}

std::optional<std::int64_t> Scrapes::oldest() const {
  std::optional<std::int64_t> oldest;
  for (const Voice& v : voices_)
    if (v.on && (!oldest || v.now.number < *oldest)) oldest = v.now.number;
  return oldest;
}

int Scrapes::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.on; }));
}

}  // namespace tactus::audio
