#include "visual_node/overlay/window_controls.h"

#include <tactus/sim_reply_t.hpp>

#include "sync/bus/request_reply.h"

namespace tactus::visual {

void WindowControls::execute(const KeyAction& key_action, Display& display, LiveOverlays& overlays) {
  switch (key_action.action) {
    case Action::kOverlay: return overlays.toggle(key_action.overlay);
    case Action::kFullScreen: return display.toggle_full_screen();
    case Action::kClose: closing_ = true; return;
    default: requests_.request(key_action.action, sync::request_id());
  }
}

void WindowControls::step(sync::HostTime now, Display& display, LiveOverlays& overlays, LiveQuestions& questions,
                    const DrawList& list, std::span<const Triangles> geometries, const Report& report) {
  if (!display.has_screen()) return;
  if (!replies_) replies_ = &bus_.queue<sim_reply_t>(channels::kSimReply, 64);
  const Inputs inputs = display.take_inputs();
  for (const int key : inputs.keys)
    if (!questions.press(key, now))
      if (const auto key_action = action_of(key)) execute(*key_action, display, overlays);
  for (const Button button : inputs.buttons) questions.press(button, now);
  if (inputs.aim)
    if (const auto hit = pick_surface(list, geometries, inputs.aim->first, inputs.aim->second))
      pointer_.aim(*hit);
  if (auto state = pointer_.state(now)) bus_.publish(channels::kDeviceState, *state);
  while (const auto m = replies_->pop())
    if (m->message.header.run_id == bus_.identity().run_id) requests_.push(m->message);
  if (auto command = requests_.step(now)) bus_.publish(channels::kSimCommand, *command);
  for (const std::string& sentence : {requests_.take_answer(), display.take_warning()})
    if (!sentence.empty()) report(sentence);
}

}  // namespace tactus::visual
