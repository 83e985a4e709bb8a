#include "audio_node/devices/file_output.h"

#include <exception>
#include <iostream>
#include <utility>

#include "audio_node/devices/file_card.h"
#include "sync/text/error_text.h"

namespace tactus::audio {
namespace {

class NamedFileCard : public FileCard {
 public:
  NamedFileCard(const StreamOptions& options, const std::string& folder, std::string name, Render render)
      : FileCard(options, folder + "/" + name, std::move(render)), name_(std::move(name)) {}
  // The name that a run uses, independent of the location of its folder.
  const std::string& medium() const override { return name_; }
  ~NamedFileCard() override {
    try {
      finish();
    } catch (const std::exception& e) {
      std::cerr << "audio_node: " << sync::error_text(e) << std::endl;
    }
  }

 private:
  std::string name_;
};

}  // namespace

OpenCard open_files(const std::string& folder, const std::string& device) {
  return [=, number = 0](const StreamOptions& options, Card::Render render) mutable -> std::unique_ptr<Card> {
    if (device == "null") return std::make_unique<FileCard>(options, "/dev/null", std::move(render));
    const std::string name = ++number == 1 ? "audio.wav" : "audio." + std::to_string(number) + ".wav";
    return std::make_unique<NamedFileCard>(options, folder, name, std::move(render));
  };
}

}  // namespace tactus::audio
