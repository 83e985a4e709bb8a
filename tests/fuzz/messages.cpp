// Arbitrary bytes, decoded as the message type that they claim to be: rejected, or a valid message whose encoding decodes to the same
// message. (The last byte of a string is read as its NUL, and encoding ends a string at an inner NUL. The new bytes then differ, and may
// be fewer or rejected.)
#include <cstdlib>
#include <tactus/answer_t.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/clock_probe_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/decode.h"

namespace {

template <class Message>
bool try_as(const std::uint8_t* data, std::size_t size) {
  const auto m = tactus::sync::decode<Message>(data, size);
  if (!m) return false;
  const auto again = tactus::sync::encode(*m);
  const auto twice = tactus::sync::decode<Message>(again.data(), again.size());
  if (again.size() > size || (twice && tactus::sync::encode(*twice) != again)) std::abort();
  return true;
}

template <class... Message>
int types_that_fit(const std::uint8_t* data, std::size_t size) {
  return (0 + ... + static_cast<int>(try_as<Message>(data, size)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus;
  const int fit =
      types_that_fit<answer_t, asset_chunk_t, asset_request_t, clock_map_t, clock_probe_t, contact_events_t, contact_frame_t,
                     degradation_t, degraded_t, device_force_t, device_state_t, frame_shown_t, game_state_t,
                     log_info_t, media_clock_t, mesh_t, node_health_t, picture_chunk_t, playout_request_t,
                     playout_t, presented_t, question_t, scene_manifest_t, scene_t, setting_change_t, setting_reply_t,
                     sim_command_t, sim_reply_t, sync_report_t, tag_list_t, tag_request_t, tag_values_t,
                     thermal_device_t, thermal_state_t, tool_state_t, touch_model_t, world_state_t>(data, size);
  if (fit > 1) std::abort();  // a message begins with the fingerprint of its type
  return 0;
}
