#include "audio_node/mixer/voices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::audio {
namespace {

// A voice below this level has ended: -100 dBFS, below the noise of any 16-bit converter.
constexpr float kEndLevel = 1e-5f;

// A voice that is weaker than the next blow by this factor jumps to the place of the blow: its crossfade within a
// block, a distortion of about 1/16 of it (spatialiser_test), is 60 dB below the blow. Design.
constexpr float kMaskedShare = 1.f / 64;

// Squared amplitude of a mode: it decays by the damping with each sample, at any phase.
float squared_amplitude(float c, float k, float v, float u) {
  return std::max(0.f, (c * v + (1 - c - k) * u) * v + k * u * u);
}

// Sum of f over the squared amplitudes of the rendered modes.
template <class Voice, class F>
float over_modes(const Voice& v, F f) {
  float sum = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.rendered); ++i)
    sum += f(squared_amplitude(v.damping[i], v.stiffness[i], v.velocity[i], v.displacement[i]));
  return sum;
}

}  // namespace

Voices::Voices(int voices, double rate_Hz, Ring ring, const Space& space, Instructions instructions)
    : limits_{voices, 1},
      ring_(ring),
      fade_step_(static_cast<float>(1 / (kFade_s * rate_Hz))),
      glide_step_rad_(kGlide_rad_s / static_cast<float>(rate_Hz)),
      voices_(static_cast<std::size_t>(voices + kFading)),
      spatialiser_(space, voices + kFading, rate_Hz, instructions) {}

void Voices::set_limits(const VoiceLimits& limits) {
  const int max = static_cast<int>(voices_.size()) - kFading;
  limits_ = {std::clamp(limits.voices, 1, max), std::max(1, limits.modes_of)};
}

Voices::Voice* Voices::find_sounding(std::int64_t id) {
  for (Voice& v : voices_)
    if (v.id == id && !v.ending.on) return &v;
  return nullptr;
}

// The weakest voices fade until at most max_voices sound. A voice that a contact drives counts as stronger, at any
// level: otherwise it would restart in each block.
void Voices::fade_weakest(int max_voices) {
  const auto sounds = [](const Voice& v) { return v.id >= 0 && !v.ending.on; };
  auto count = std::count_if(voices_.begin(), voices_.end(), sounds);
  for (; count > max_voices; --count) {
    Voice* weakest = nullptr;
    for (Voice& v : voices_)
      if (sounds(v) &&
          (!weakest || std::pair(v.driven > 0, v.level) < std::pair(weakest->driven > 0, weakest->level)))
        weakest = &v;
    weakest->ending.on = true;
  }
}

// Returns a free voice. If there is none, returns the weakest of the fading voices. There is always one, because
// more voices exist than may sound.
Voices::Voice& Voices::free_voice() {
  Voice* best = nullptr;
  for (Voice& v : voices_) {
    if (v.id < 0) return v;
    if (v.ending.on && (!best || v.level < best->level)) best = &v;
  }
  return *best;
}

int Voices::allowed_modes(const Voice& v) const {
  const int groups = v.modes / kModeGroup;
  return (groups + limits_.modes_of - 1) / limits_.modes_of * kModeGroup;
}

void Voices::start(Voice& v, std::int64_t id, const Resonators& resonators, const SourcePosition& place) {
  v.id = id;
  v.modes = (std::clamp(resonators.count, 0, kMaxModes) + kModeGroup - 1) / kModeGroup * kModeGroup;
  v.rendered = v.kept = allowed_modes(v);
  v.cut = v.ending = {};
  v.damping = resonators.damping, v.stiffness = resonators.stiffness;
  v.velocity.fill(0), v.displacement.fill(0);
  for (Pulse& p : v.pulses) p.on = false;
  v.driven = 0;
  v.place = v.current_place = place;
  v.silent = 0;
  spatialiser_.begin(static_cast<int>(&v - voices_.data()));
  v.expected = v.level = v.last = 0;
}

// Its state is not a number: it comes to rest, and its sound goes linearly to zero within the block.
void Voices::silence(Voice& v, float* samples, int frames) {
  for (int n = 0; n < frames; ++n) samples[n] = v.last * (1 - static_cast<float>(n + 1) / static_cast<float>(frames));
  v.velocity.fill(0), v.displacement.fill(0);
  for (Pulse& p : v.pulses) p.on = false;
  v.expected = 0;
}

void Voices::clear() {
  for (Voice& v : voices_) v.id = -1, v.driven = 0;
}

Voices::Voice& Voices::voice_for(std::int64_t id, const Resonators& resonators, const SourcePosition& place) {
  if (Voice* known = find_sounding(id)) return *known;
  fade_weakest(limits_.voices - 1);
  Voice& fresh = free_voice();
  start(fresh, id, resonators, place);
  return fresh;
}

// Restores cut modes at rest, before a force begins: during a force they would jump.
void Voices::restore_modes(Voice& v) const {
  const auto pushes = [](const Pulse& p) { return p.on; };
  if (!v.cut.on && v.rendered < allowed_modes(v) && v.driven == 0 &&
      std::none_of(v.pulses.begin(), v.pulses.end(), pushes))
    v.rendered = v.kept = allowed_modes(v);
}

// The blow keeps its time and strength, and takes the place on the body of the strongest pulse that has room,
// which carries most of the force. A blow without room is masked by the 80 active humps.
void Voices::join(Voice& v, const Pulse& blow) {
  Pulse* into = nullptr;
  for (Pulse& p : v.pulses)
    if (has_room(p.humps, -p.begin) && (!into || std::abs(p.impulse) > std::abs(into->impulse))) into = &p;
  if (!into) return;
  if (into->impulse == 0) {
    *into = blow;
    return;
  }
  audio::join(into->humps, -into->begin, blow.humps, blow.begin - into->begin, blow.impulse / into->impulse);
  into->end = length_of(into->humps);
}

void Voices::strike(const StrikeSide& side, float gain, const ForcePulse& pulse, int offset) {
  if (side.voice < 0) return;
  Voice& v = voice_for(side.voice, *side.resonators, side.place);
  v.place = side.place;
  restore_modes(v);
  const auto free = std::find_if_not(v.pulses.begin(), v.pulses.end(), [](const Pulse& p) { return p.on; });
  const Pulse blow{true, offset, length_of(pulse), pulse, gain * side.impulse, gain * side.click, 0, side.gains};
  if (free != v.pulses.end())
    *free = blow;
  else
    join(v, blow);
  float response = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.rendered); ++i) response += std::abs(side.gains[i]);
  v.expected = gain * (std::abs(side.impulse) * response + std::abs(side.click));
  if (v.level * side.place.distance_m < kMaskedShare * v.expected) v.current_place = side.place;
  v.level += v.expected;
}

void Voices::drive(const Drive& drive) {
  if (drive.voice < 0) return;
  Voice& v = voice_for(drive.voice, *drive.resonators, drive.place);
  v.place = drive.place;
  if (v.driven == kDrives) return;
  restore_modes(v);
  v.direct_sounds[static_cast<std::size_t>(v.driven)] = drive.direct;
  v.drives[static_cast<std::size_t>(v.driven++)] = {drive.gains->data(), drive.force};
}

// Collects the forces of the block; clicks and direct sound are added to `out`.
void Voices::collect(Voice& v, int frames, Pushes& pushes, float* out) {
  for (std::size_t i = 0; i < v.pulses.size(); ++i) {
    Pulse& p = v.pulses[i];
    if (!p.on) continue;
    std::array<float, kMaxBlock>& force = pushes.forces[i];
    std::fill(force.begin(), force.end(), 0.f);
    for (int n = std::max(0, p.begin); n < frames && n <= p.begin + p.end; ++n) {
      const auto k = static_cast<std::size_t>(n);
      const float weight = weight_at(p.humps, n - p.begin);
      force[k] = p.impulse * weight;
      out[k] += p.click * (weight - p.weight);
      p.weight = weight;
    }
    pushes.list[static_cast<std::size_t>(pushes.count++)] = {p.gains.data(), force.data()};
    p.begin -= frames;
    p.on = p.begin + p.end >= 0;
  }
  pushes.of_blows = pushes.count > 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.driven); ++i) {
    pushes.list[static_cast<std::size_t>(pushes.count++)] = v.drives[i];
    for (int n = 0; v.direct_sounds[i] && n < frames; ++n) out[n] += v.direct_sounds[i][n];
  }
  v.driven = 0;
}

void Voices::resonate(Voice& v, int from, int to, int frames, const Pushes& pushes, float* out) const {
  std::array<Push, kPulses + kDrives> shifted;
  for (int i = 0; i < pushes.count; ++i) {
    const Push& p = pushes.list[static_cast<std::size_t>(i)];
    shifted[static_cast<std::size_t>(i)] = {p.gains + from, p.force};
  }
  ring_({v.damping.data() + from, v.stiffness.data() + from, v.velocity.data() + from,
         v.displacement.data() + from, to - from},
        shifted.data(), pushes.count, frames, out);
}

void Voices::fade(Fade& fade, float* samples, int frames) const {
  for (int n = 0; fade.on && n < frames; ++n) {
    fade.gain = std::max(0.f, fade.gain - fade_step_);
    samples[n] *= fade.gain;
  }
}

// Begins to fade out the modes above the limit. Does nothing while another cut is in progress.
void Voices::cut(Voice& v) const {
  if (v.cut.on || v.rendered <= allowed_modes(v)) return;
  v.kept = allowed_modes(v);
  v.cut.on = true;
}

void Voices::end_cut(Voice& v) const {
  if (!v.cut.on || v.cut.gain > 0) return;
  for (int i = v.kept; i < v.rendered; ++i)
    v.velocity[static_cast<std::size_t>(i)] = v.displacement[static_cast<std::size_t>(i)] = 0;
  v.rendered = v.kept;
  v.cut = {};
}

void Voices::render(Voice& v, int frames) {
  cut(v);
  std::array<float, kMaxBlock> out{};
  Pushes pushes;
  collect(v, frames, pushes, out.data());
  resonate(v, 0, v.kept, frames, pushes, out.data());
  if (v.cut.on) {
    std::array<float, kMaxBlock> leaving{};
    resonate(v, v.kept, v.rendered, frames, pushes, leaving.data());
    fade(v.cut, leaving.data(), frames);
    for (int n = 0; n < frames; ++n) out[static_cast<std::size_t>(n)] += leaving[static_cast<std::size_t>(n)];
    end_cut(v);
  }
  fade(v.ending, out.data(), frames);
  const bool numbers = std::all_of(out.begin(), out.begin() + frames, [](float x) { return std::isfinite(x); });
  if (!numbers) silence(v, out.data(), frames);
  v.last = out[static_cast<std::size_t>(frames - 1)];
  const Eigen::Vector3d ear_m = listener_.value_or(Listener{}).T_W_listener.translation();
  v.current_place = glide(v.current_place, v.place, ear_m, glide_step_rad_ * static_cast<float>(frames));
  const SourcePosition place = listener_ ? relative_to_listener(*listener_, v.current_place) : v.current_place;
  spatialiser_.add(static_cast<int>(&v - voices_.data()), place, out.data(), frames);
  v.level = over_modes(v, [](float a2) { return std::sqrt(a2); }) / place.distance_m * v.ending.gain;
  const bool pushed = pushes.count > 0;
  // Sound in the filters of the ears still counts.
  const bool over = v.ending.gain <= 0 || (!pushed && !(v.level > kEndLevel));
  if (!std::isfinite(v.level) || (over && v.silent >= spatialiser_.tail())) v.id = -1;
  v.silent = over ? v.silent + frames : 0;
  if (pushes.of_blows) v.level += v.expected;
}

void Voices::render(float* mix, int frames) {
  fade_weakest(limits_.voices);
  for (Voice& v : voices_)
    if (v.id >= 0) render(v, frames);
  spatialiser_.mix(mix, frames);
}

int Voices::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.id >= 0; }));
}

double Voices::energy() const {
  double sum = 0;
  for (const Voice& v : voices_)
    if (v.id >= 0) sum += static_cast<double>(over_modes(v, [](float a2) { return a2; }));
  return sum;
}

}  // namespace tactus::audio
