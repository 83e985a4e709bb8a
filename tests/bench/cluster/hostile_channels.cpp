// Every channel with a generator of valid messages and its border.
#include <stdexcept>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "tests/bench/cluster/hostile_source.h"
#include "tests/lcmtypes/samples.h"

namespace tactus::bench {
namespace {

template <class Message>
HostileChannel channel(const char* name) {
  return {name, Message::getTypeName(),
          [](unsigned seed) {
            test::Samples samples(seed);
            Bytes bytes;
            do {
              Message m{};
              samples.fill(m);
              bytes = sync::encode(m);
            } while (bytes.size() > channels::kMaxMessageBytes);
            return bytes;
          },
          [](const Bytes& bytes) { return sync::decode<Message>(bytes.data(), bytes.size()).has_value(); }};
}

}  // namespace

const std::vector<HostileChannel>& hostile_channels() {
  static const std::vector<HostileChannel> all{
      channel<touch_model_t>(channels::kTouchModel),
      channel<contact_events_t>(channels::kContactEvents),
      channel<contact_frame_t>(channels::kContacts),
      channel<world_state_t>(channels::kWorldState),
      channel<tool_state_t>(channels::kToolState),
      channel<device_state_t>(channels::kDeviceState),
      channel<device_force_t>(channels::kDeviceForce),
      channel<thermal_state_t>(channels::kThermalState),
      channel<thermal_device_t>(channels::kThermalDevice),
      channel<presented_t>(channels::kPresented),
      channel<node_health_t>(channels::kNodeHealth),
      channel<sync_report_t>(channels::kSyncReport),
      channel<clock_probe_t>(channels::kClockProbe),
      channel<clock_map_t>(channels::kClockMap),
      channel<media_clock_t>(channels::kMediaClock),
      channel<frame_shown_t>(channels::kFrameShown),
      channel<playout_t>(channels::kPlayout),
      channel<playout_request_t>(channels::kPlayoutRequest),
      channel<degradation_t>(channels::kDegradation),
      channel<degraded_t>(channels::kDegraded),
      channel<sim_command_t>(channels::kSimCommand),
      channel<sim_reply_t>(channels::kSimReply),
      channel<setting_change_t>(channels::kSetting),
      channel<setting_reply_t>(channels::kSettingReply),
      channel<question_t>(channels::kQuestion),
      channel<answer_t>(channels::kAnswer),
      channel<tag_request_t>(channels::kTagRequest),
      channel<tag_list_t>(channels::kTagList),
      channel<tag_values_t>(channels::kTagValues),
      channel<game_state_t>(channels::kGameState),
      channel<log_info_t>(channels::kLogInfo),
      channel<scene_manifest_t>(channels::kSceneManifest),
      channel<asset_request_t>(channels::kAssetRequest),
      channel<asset_chunk_t>(channels::kAssetChunk),
      channel<picture_chunk_t>(channels::kPictureChunk),
  };
  return all;
}

const HostileChannel& hostile_channel(std::string_view name) {
  for (const HostileChannel& c : hostile_channels())
    if (name == c.name) return c;
  throw std::runtime_error(std::string(name) + " has no hostile messages; add it to tests/bench/cluster/hostile_channels.cpp");
}

}  // namespace tactus::bench
