// Validation of received messages: finite numbers, counts and enumerations in range. Code behind this border never
// receives a NaN. sync/bus/decode.h checks the sizes first.
#pragma once

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

namespace tactus {

// True when every field is in the range that its comment in the .lcm file gives.
bool valid(const answer_t&);
bool valid(const asset_chunk_t&);
bool valid(const asset_request_t&);
bool valid(const clock_map_t&);
bool valid(const clock_probe_t&);
bool valid(const contact_events_t&);
bool valid(const contact_frame_t&);
bool valid(const degradation_t&);
bool valid(const degraded_t&);
bool valid(const device_force_t&);
bool valid(const device_state_t&);
bool valid(const frame_shown_t&);
bool valid(const game_state_t&);
bool valid(const log_info_t&);
bool valid(const media_clock_t&);
bool valid(const mesh_t&);
bool valid(const node_health_t&);
bool valid(const picture_chunk_t&);
bool valid(const playout_t&);
bool valid(const playout_request_t&);
bool valid(const presented_t&);
bool valid(const question_t&);
bool valid(const scene_manifest_t&);
bool valid(const scene_t&);
bool valid(const setting_change_t&);
bool valid(const setting_reply_t&);
bool valid(const sim_command_t&);
bool valid(const sim_reply_t&);
bool valid(const sync_report_t&);
bool valid(const tag_list_t&);
bool valid(const tag_request_t&);
bool valid(const tag_values_t&);
bool valid(const thermal_device_t&);
bool valid(const thermal_state_t&);
bool valid(const tool_state_t&);
bool valid(const touch_model_t&);
bool valid(const world_state_t&);

}  // namespace tactus
