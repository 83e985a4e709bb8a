// The largest number of pages of each kind of message. Messages with more are refused where they enter a program: a receiver
// stores pages until the last one arrives, and a corrupt count must not make it store pages that never complete.
#pragma once

namespace tactus {

// WORLD_STATE: 36,000 bodies, the most that a receiver stores (sync/resampling/body_history.h), at least 18 a page.
inline constexpr int kMaxWorldPages = 2048;
// CONTACTS: 2,000 contacts, at least two a page, need 1,000 pages; a converted log has twice the pages of its recording, which held
// at least three a page.
inline constexpr int kMaxContactPages = 2048;
// Of any stream of snapshots; TOUCH_MODEL counts its pages in a byte.
inline constexpr int kMaxStatePages = kMaxWorldPages;
// CONTACT_EVENTS: at most 224 events a step (setting event_pages of sim_node), at least 13 a page, need 18 pages; a converted log
// has twice the pages of its recording.
inline constexpr int kMaxEventPages = 64;
// SYNC_REPORT: 64 modalities have 2,016 pairs, at least 6 a page, and need 336 pages, and 7 for themselves.
inline constexpr int kMaxReportPages = 512;
// DEGRADATION: 64 kB of text, 1,200 bytes a page.
inline constexpr int kMaxProfilePages = 55;
// QUESTION: 600 characters and nine choices of 40 have at most 3,885 bytes; page 0 has room for 500 of them, each other page for
// at least 1,100, since a choice of 165 bytes is not divided.
inline constexpr int kMaxQuestionPages = 8;
// SCENE_MANIFEST: 512 assets, twelve a page, need 43 pages.
inline constexpr int kMaxManifestPages = 64;
// ASSET_CHUNK: 64 MiB, 1,024 bytes a chunk.
inline constexpr int kMaxAssetChunks = 65536;
// PICTURE_CHUNK: 4 MiB, 1,024 bytes a chunk (sync/tools/picture_reader.h).
inline constexpr int kMaxPictureChunks = 4096;

}  // namespace tactus
