#include "audio_node/offline.h"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "audio_node/devices/file_card.h"

namespace tactus::audio {

void OfflineOptions::add_to(sync::Arguments& app) {
  sync::OfflineOptions::add_to(app, "renders this log of a run", "--wav");
  app.add_option("--wav", wav, "file for the sound of the log").needs("--log");
}

std::unique_ptr<Offline> Offline::open(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock) {
  if (options.log.empty()) return nullptr;
  if (options.wav.empty()) throw std::runtime_error("--log needs --wav FILE, the file for the sound");
  return std::make_unique<Offline>(options, loop_rate_Hz, clock);
}

Offline::Offline(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock)
    : run_(options, {{options.wav, "--wav"}}, loop_rate_Hz, clock, kDecayTime), wav_(options.wav) {}

OpenCard Offline::open_card() {
  return [this](const StreamOptions& options, Card::Render render) {
    if (card_)
      throw std::runtime_error(
          "the log changes the rate, period, ceiling, ears or instructions midway; set them with --set");
    auto made = std::make_unique<FileCard>(options, wav_, std::move(render));
    card_ = made.get();
    return made;
  };
}

std::string Offline::result(double rate_Hz, std::int64_t hits, std::int64_t dropped, sync::HostTime clock) {
  if (!card_ || !card_->start()) throw std::runtime_error(run_.no_scene());
  const double sound_s = static_cast<double>(card_->frames()) / rate_Hz;
  const std::string rest = run_.finish(sound_s, clock);
  card_->finish();
  std::ostringstream text;
  text << wav_ << ": " << sound_s << " s of sound, " << hits << " hits";
  if (dropped > 0) text << " (" << dropped << " of them dropped: too late, or silenced by a profile)";
  if (hits > 0 && hits == dropped) text << "; it is silent, because every hit was dropped";
  text << "; its first sample was out at " << sync::to_ns(*card_->start()) << " ns" << rest;
  return text.str();
}

}  // namespace tactus::audio
