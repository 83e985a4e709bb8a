#include "sync/sandbox/regular_file.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "sync/log/mapped_log.h"
#include "sync/sandbox/readable_folders.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;
namespace fs = std::filesystem;

namespace {

struct Folder : TemporaryFolder {
  std::string file(const std::string& name) const { return (path / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }
};

std::string refusal(const fs::path& file, std::uintmax_t max_bytes = 1 << 20) {
  try {
    read_regular_file(file, max_bytes);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("A pipe, a device, a folder and a large file are rejected without waiting") {
  const Folder folder;
  folder.write("text", "four");
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", folder.file("zero"));
  fs::create_symlink(folder.file("pipe"), folder.file("link"));
  fs::create_symlink("loop", folder.file("loop"));
  for (const char* name : {"pipe", "zero", "link", "."}) CHECK(refusal(folder.path / name) == "it is not a regular file");
  CHECK(refusal("/dev/tty") != "");
  CHECK(refusal(folder.file("none")) == "it does not exist");
  CHECK(refusal(folder.file("loop")) == "it does not exist");
  CHECK(refusal(folder.path / std::string(5000, 'x')) == "it does not exist");
  CHECK(refusal(folder.path / std::string("text\0.png", 9)) == "it does not exist");
  CHECK(refusal(folder.file("text"), 3) == "it is larger than 0 KiB");
  fs::resize_file(folder.file("text"), (1 << 20) + 1);
  CHECK(refusal(folder.file("text")) == "it is larger than 1 MiB");
  CHECK(read_regular_text(folder.file("text"), 2 << 20).substr(0, 5) == std::string("four\0", 5));
}

TEST_CASE("A log that is a pipe or a device is refused at once") {
  const Folder folder;
  REQUIRE(mkfifo(folder.file("run.lcmlog").c_str(), 0600) == 0);
  for (const std::string& log : {folder.file("run.lcmlog"), std::string("/dev/zero")})
    CHECK_THROWS_WITH(MappedLog(log, LogTypes::kAny), Catch::Contains(log) && Catch::Contains("not a regular file"));
}

TEST_CASE("A path is readable below its folders only, after links are resolved, and never when it is hidden") {
  const Folder folder;
  for (const char* name : {"scene/a.obj", "scene/models/b.obj", "scene/.ssh/key", "scene/.env", "scenery/c.obj", "secret"})
    folder.write(name, "x");
  fs::create_symlink("../secret", folder.path / "scene/link");
  fs::create_symlink("..", folder.path / "scene/up");
  fs::create_symlink("models/b.obj", folder.path / "scene/inside");
  fs::create_symlink(".ssh/key", folder.path / "scene/key");
  const ReadableFolders readable({folder.path / "scene"});
  const auto allowed = [&](const char* name) { return readable.resolve(folder.path / "scene" / name).has_value(); };
  for (const char* name : {"a.obj", "models/b.obj", "models/../a.obj", "inside", "./a.obj", "../scene/a.obj"}) {
    INFO(name);
    CHECK(allowed(name));
  }
  for (const char* name : {"../secret", "link", "up/secret", "/etc/passwd", "../scenery/c.obj", ".ssh/key", ".env", "key",
                           "none", "models/../../secret", "up/scenery/c.obj"}) {
    INFO(name);
    CHECK_FALSE(allowed(name));
  }
  CHECK_FALSE(readable.resolve(folder.path / "scene" / std::string("a.obj\0x", 7)));
  // A folder that the user names may itself be hidden, or a link.
  fs::create_symlink(folder.path / "scene/.ssh", folder.path / "named");
  CHECK(ReadableFolders({folder.path / "named"}).resolve(folder.path / "scene/.ssh/key"));
  CHECK(ReadableFolders({folder.path / "none"}).folders().empty());
}
