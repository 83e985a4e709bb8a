// Any bytes, decoded as each message type in turn: refused, or a valid message that encodes to the same bytes.
#include <cstdlib>
#include <cstring>

#include "sync/decode.h"

namespace {

template <class Message>
void try_as(const std::uint8_t* data, std::size_t size) {
  const auto m = tactus::sync::decode<Message>(data, size);
  if (!m) return;
  const auto again = tactus::sync::encode(*m);
  if (again.size() != size || std::memcmp(again.data(), data, size) != 0) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus;
  try_as<asset_chunk_t>(data, size);
  try_as<asset_request_t>(data, size);
  try_as<clock_map_t>(data, size);
  try_as<clock_probe_t>(data, size);
  try_as<contact_events_t>(data, size);
  try_as<contact_frame_t>(data, size);
  try_as<degradation_t>(data, size);
  try_as<degraded_t>(data, size);
  try_as<device_force_t>(data, size);
  try_as<device_state_t>(data, size);
  try_as<frame_shown_t>(data, size);
  try_as<game_state_t>(data, size);
  try_as<log_info_t>(data, size);
  try_as<media_clock_t>(data, size);
  try_as<mesh_t>(data, size);
  try_as<node_health_t>(data, size);
  try_as<picture_chunk_t>(data, size);
  try_as<playout_t>(data, size);
  try_as<playout_request_t>(data, size);
  try_as<presented_t>(data, size);
  try_as<scene_manifest_t>(data, size);
  try_as<scene_t>(data, size);
  try_as<setting_change_t>(data, size);
  try_as<setting_reply_t>(data, size);
  try_as<sim_command_t>(data, size);
  try_as<sim_reply_t>(data, size);
  try_as<sync_report_t>(data, size);
  try_as<tag_list_t>(data, size);
  try_as<tag_request_t>(data, size);
  try_as<tag_values_t>(data, size);
  try_as<thermal_device_t>(data, size);
  try_as<thermal_state_t>(data, size);
  try_as<tool_state_t>(data, size);
  try_as<touch_model_t>(data, size);
  try_as<world_state_t>(data, size);
  return 0;
}
