// save_pictures: writes the pictures that a visual_node streams into JPEG files.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <tactus/picture_chunk_t.hpp>

#include "sync/bus/bus.h"
#include "sync/bus/bus_arguments.h"
#include "sync/node/node_options.h"
#include "sync/tools/picture_reader.h"

using namespace tactus;

int main(int argc, char** argv) try {
  sync::Arguments app("Writes the pictures that a visual_node streams into JPEG files: FOLDER/SOURCE_NUMBER.jpg.");
  sync::BusOptions bus_options;
  std::int64_t run_id = 1;
  std::string folder;
  int pictures = 10;
  double seconds = 10;
  app.add_option("FOLDER", folder, "created when it does not exist").required();
  app.add_option("--pictures", pictures, "number of pictures after which it ends").range(1, 100000).show_default();
  app.add_option("--seconds", seconds, "ends when no picture has arrived for this time").range(0.1, 3600.0).show_default();
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  sync::parse_or_exit(app, "save_pictures", argc, argv);
  std::filesystem::create_directories(folder);

  sync::Bus bus(sync::Identity::fresh("save_pictures", run_id), bus_options);
  auto& chunks = bus.queue<picture_chunk_t>(channels::kPictureChunk, 4096, sync::Port::kBoth);
  sync::PictureReader reader;
  int saved = 0;
  for (sync::HostTime newest = sync::host_now(); saved < pictures && sync::host_now() - newest < sync::from_seconds(seconds);) {
    bus.wait(sync::from_seconds(0.1));
    bus.drain(sync::host_now());
    while (const auto m = chunks.pop()) {
      const auto picture = saved < pictures ? reader.push(m->message) : std::nullopt;
      if (!picture) continue;
      char name[64];
      std::snprintf(name, sizeof name, "%08x_%06lld.jpg", static_cast<unsigned>(picture->source), static_cast<long long>(picture->picture));
      std::ofstream file(std::filesystem::path(folder) / name, std::ios::binary);
      file.write(reinterpret_cast<const char*>(picture->jpeg.data()), static_cast<std::streamsize>(picture->jpeg.size()));
      if (!file.flush())
        throw std::runtime_error(folder + ": " + name +
                                 " cannot be written; give a writable folder with free space");
      ++saved;
      newest = sync::host_now();
    }
  }
  std::cout << saved << " pictures saved, " << reader.skipped() << " were incomplete" << std::endl;
  if (saved == 0) throw std::runtime_error("no picture arrived; start a visual_node on this bus with --set stream=10");
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("save_pictures", e);
}
