// The audio renderer of the node: prepares strikes and lasting contacts, which the callback of the sound card
// renders.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "audio_node/excitation/due_hits.h"
#include "audio_node/spatial/ear.h"
#include "audio_node/excitation/impact.h"
#include "audio_node/offline.h"
#include "audio_node/devices/output.h"
#include "audio_node/excitation/sampler.h"
#include "audio_node/excitation/sliding.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/node/renderer.h"
#include "sync/node/background_task.h"

namespace tactus::audio {

// Command-line options of this node; every node has further common options.
struct Options {
  std::string device;     // empty: the setting
  bool no_sound = false;  // computes no samples
  OfflineOptions log;

  void add_to(sync::Arguments& app);
  // Throws std::runtime_error with one sentence.
  void check() const;
};

class NodeRenderer : public sync::SettingsRenderer<Settings> {
 public:
  // log: null: renders the bus.
  NodeRenderer(sync::RendererHost& host, const Options& options, Offline* log);

  std::optional<sync::Status> step(sync::HostTime now) override;
  std::string finish_log(sync::HostTime clock) override {
    return log_->result(output_.settings().sample_rate_Hz, hits_, dropped_, clock);
  }

 private:
  sync::LoadedScene load(const sync::SceneReceiver& scenes, const Settings& settings) override;
  void apply_setting(const Settings& settings, const std::string& name) override;
  void configure(const Settings& settings);
  void add_tags();
  void start_loading_surfaces(const sync::SceneReceiver& scenes);
  void poll_loading();
  void take_surfaces();
  void receive();
  void process_due_hits(sync::HostTime now);
  void strike(const contact_event_t& event, sync::HostTime scheduled);
  void drop(const contact_event_t& event, sync::HostTime scheduled) { output_.drop(event.event_id, scheduled); }
  void submit_contacts(sync::HostTime now);
  void publish();
  void print_messages();
  sync::Status status(sync::HostTime now, bool plays);

  Offline* log_;
  bool no_sound_;
  bool real_time_;  // false for a log or virtual time, which play into a file and wait for background reading
  sync::ModalityEndpoint::Events& events_;
  sync::ModalityEndpoint::Stream<contact_frame_t>& frames_;
  sync::ModalityEndpoint::Stream<world_state_t>& world_;
  // bypasses the profile, which delays or thins events; the position of the ear is not an event
  sync::Queue<tool_state_t>& tools_;
  Ear listener_;
  sync::ContactStream contacts_;
  sync::BodyHistory bodies_;
  Output output_;
  const scene_t* scene_ = nullptr;
  std::unique_ptr<Impacts> impacts_;
  std::unique_ptr<Sliding> sliding_;
  std::unique_ptr<Sampler> sampler_;
  std::optional<sync::BackgroundTask<AudioSurfaces>> loading_surfaces_;
  sync::HostTime started_;
  std::optional<sync::SimTime> scraped_at_, submitted_at_;  // instants of the world, of lasting contacts
  std::int64_t scenes_ = 0, hits_ = 0, dropped_ = 0;
};

}  // namespace tactus::audio
