// The channels of the bus: names and ports. README.md lists publishers and subscribers.
#pragma once

#include <cstddef>

namespace tactus::channels {

// Real-time port. No message is larger than kMaxMessageBytes: large snapshots are split into pages.
inline constexpr const char* kTouchModel = "TOUCH_MODEL";        // touch_model_t
inline constexpr const char* kContactEvents = "CONTACT_EVENTS";  // contact_events_t
inline constexpr const char* kContacts = "CONTACTS";             // contact_frame_t
inline constexpr const char* kWorldState = "WORLD_STATE";        // world_state_t
inline constexpr const char* kToolState = "TOOL_STATE";          // tool_state_t
inline constexpr const char* kDeviceState = "DEVICE_STATE";      // device_state_t
inline constexpr const char* kDeviceForce = "DEVICE_FORCE";      // device_force_t
inline constexpr const char* kThermalState = "THERMAL_STATE";    // thermal_state_t
inline constexpr const char* kThermalDevice = "THERMAL_DEVICE";  // thermal_device_t
inline constexpr const char* kPresented = "PRESENTED";           // presented_t
inline constexpr const char* kNodeHealth = "NODE_HEALTH";        // node_health_t
inline constexpr const char* kSyncReport = "SYNC_REPORT";        // sync_report_t
inline constexpr const char* kClockProbe = "CLOCK_PROBE";        // clock_probe_t
inline constexpr const char* kClockMap = "CLOCK_MAP";            // clock_map_t
inline constexpr const char* kMediaClock = "MEDIA_CLOCK";        // media_clock_t
inline constexpr const char* kFrameShown = "FRAME_SHOWN";        // frame_shown_t
inline constexpr const char* kPlayout = "PLAYOUT";               // playout_t
inline constexpr const char* kPlayoutRequest = "PLAYOUT_REQUEST";  // playout_request_t
inline constexpr const char* kDegradation = "DEGRADATION";       // degradation_t
inline constexpr const char* kDegraded = "DEGRADED";             // degraded_t
inline constexpr const char* kSimCommand = "SIM_COMMAND";        // sim_command_t
inline constexpr const char* kSimReply = "SIM_REPLY";            // sim_reply_t
inline constexpr const char* kSetting = "SETTING";               // setting_change_t
inline constexpr const char* kSettingReply = "SETTING_REPLY";    // setting_reply_t
inline constexpr const char* kQuestion = "QUESTION";             // question_t
inline constexpr const char* kAnswer = "ANSWER";                 // answer_t
inline constexpr const char* kTagRequest = "TAG_REQUEST";        // tag_request_t
inline constexpr const char* kTagList = "TAG_LIST";              // tag_list_t
inline constexpr const char* kTagValues = "TAG_VALUES";          // tag_values_t
inline constexpr const char* kGameState = "GAME_STATE";          // game_state_t
inline constexpr const char* kLogInfo = "LOG_INFO";              // log_info_t, only in logs

// Bulk port, so that assets never delay a force. Receivers listen on both ports: a replayed log has only one.
inline constexpr const char* kSceneManifest = "SCENE_MANIFEST";  // scene_manifest_t
inline constexpr const char* kAssetRequest = "ASSET_REQUEST";    // asset_request_t
inline constexpr const char* kAssetChunk = "ASSET_CHUNK";        // asset_chunk_t
inline constexpr const char* kPictureChunk = "PICTURE_CHUNK";    // picture_chunk_t

// One Ethernet frame minus the headers of IP, UDP and LCM: messages are never fragmented, so never partly lost.
inline constexpr std::size_t kMaxMessageBytes = 1400;

// Multicast group, real-time port and its bulk port (the next one), unless the command line sets others.
inline constexpr const char* kGroup = "239.255.76.67";
inline constexpr int kDefaultPort = 7667;

}  // namespace tactus::channels
