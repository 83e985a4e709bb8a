// Validation of received messages: finite numbers, counts and enumerations in range. Code behind this border never
// receives a NaN. sync/bus/decode.h checks the sizes first.
#pragma once

namespace tactus {

class answer_t;
class asset_chunk_t;
class asset_request_t;
class clock_map_t;
class clock_probe_t;
class contact_events_t;
class contact_frame_t;
class degradation_t;
class degraded_t;
class device_force_t;
class device_state_t;
class frame_shown_t;
class game_state_t;
class log_info_t;
class media_clock_t;
class mesh_t;
class node_health_t;
class picture_chunk_t;
class playout_request_t;
class playout_t;
class presented_t;
class question_t;
class scene_manifest_t;
class scene_t;
class setting_change_t;
class setting_reply_t;
class sim_command_t;
class sim_reply_t;
class sync_report_t;
class tag_list_t;
class tag_request_t;
class tag_values_t;
class thermal_device_t;
class thermal_state_t;
class tool_state_t;
class touch_model_t;
class world_state_t;

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
