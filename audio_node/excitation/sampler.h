// Selects the recordings for the contacts of a scene, and their strength relative to the modes. Pure.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>
#include <utility>
#include <vector>

#include "audio_node/excitation/contact_motion.h"
#include "audio_node/excitation/impact.h"
#include "audio_node/samples/database.h"
#include "audio_node/samples/shot.h"
#include "audio_node/settings.gen.h"
#include "sync/resampling/contact_stream.h"

namespace tactus::audio {

// Factors on the amplitudes of the modal and the recorded sound.
struct MethodGains {
  float modal = 1, recorded = 0;
};
MethodGains gains_of(const Settings& settings);

// Level at 1 m of a blow of that impulse, relative to the level of its recording: gain and recorded_level are included.
double recorded_blow_level(double impulse_N_s, const Settings& settings);
// Playback speed relative to the recording: free vibrations of bodies of one form and material scale as 1 / size
// (Fletcher and Rossing, The Physics of Musical Instruments, 1998, chapters 2 and 3).
double pitch_of(double size_m, double recorded_size_m);

// Selects and scales the recordings of the impacts and contacts of one scene.
class Sampler {
 public:
  Sampler(const scene_t& scene, const Settings& settings);

  void configure(const Settings& settings) { settings_ = settings; }
  // T_world_listener from the next contacts on; initially that of the scene.
  void set_listener(const Eigen::Isometry3d& listener) { listener_ = listener; }
  // Interval between updates of contacts.
  void set_update_interval(double period_s) { period_s_ = period_s; }
  // Sets the database in use; null: none. It must outlive all calls until the next call of this.
  void set_database(const Database* database, std::int64_t number) {
    if (number != database_number_) reported_missing_.clear();
    database_ = database, database_number_ = number;
  }

  // False: no recording is in use, and contacts need not be processed.
  bool enabled() const { return database_ && gains_of(settings_).recorded > 0; }
  // Adds the recordings of its event to a strike, and scales its modes by the method.
  void add_recordings(Strike& strike, const contact_event_t& event, const Impacts& impacts);
  // Recorded parts of these contacts that are audible at `at`; each part that is no longer audible ends once. When
  // the method changes they fade out by themselves.
  const std::vector<RecordedContact>& recorded_contacts(const sync::Contacts& contacts, sync::HostTime at);
  // Factor on the computed scraping or rolling of a contact, as of the last recorded_contacts().
  float modal_gain(std::int64_t contact, Interaction interaction) const;

  // Returns one sentence for each pair and interaction without its own recording, once.
  std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

 private:
  Database::Found find(std::int32_t a, std::int32_t b, Interaction interaction);
  std::string material(std::int32_t index) const;
  void report_missing(const std::string& a, const std::string& b, Interaction interaction, const Database::Found& found);
  void keep_loudest();
  void end_stopped_contacts(sync::HostTime at);
  void add_contact(const contact_t& contact, Interaction interaction, double speed_m_s, double level, sync::HostTime at);

  Settings settings_;
  Eigen::Isometry3d listener_;
  std::vector<std::string> materials_;
  std::vector<double> mu_;  // by material
  const Database* database_ = nullptr;
  std::int64_t database_number_ = 0;
  double period_s_ = 0;
  std::vector<RecordedContact> contacts_;
  std::set<std::pair<std::int64_t, std::int32_t>> playing_;  // contacts and parts of the last recorded_contacts()
  sync::HostTime updated_at_{};                                // presentation time of the last recorded_contacts()
  struct Motion {
    Presliding slides, rolls;
    bool present = true;
  };
  std::map<std::int64_t, Motion> motions_;                      // of each contact
  std::set<std::pair<std::int64_t, Interaction>> recorded_;  // contacts of the last recorded_contacts()
  std::set<Database::Key> reported_missing_;
  std::vector<std::string> messages_;
};

}  // namespace tactus::audio
