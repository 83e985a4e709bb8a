#include "sync/node/node.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;
using Catch::Contains;

TEST_CASE("An output file in a missing folder is refused with its option, before it is created") {
  const TemporaryFolder folder;
  const std::string there = (folder.path / "a.png").string(), missing = (folder.path / "none" / "a.png").string();
  CHECK_NOTHROW(check_folder_of(there, "--snapshot"));
  CHECK_NOTHROW(check_folder_of("a.png", "--snapshot"));
  CHECK_THROWS_WITH(check_folder_of(missing, "--snapshot"), Contains(missing) && Contains("No such file") && Contains("another --snapshot"));
  CHECK_THROWS_WITH(check_folder_of(there + "/b.png", "--snapshot"), Contains("another --snapshot"));
  CHECK_FALSE(std::filesystem::exists(there));
  if (geteuid() == 0) return;  // root may write everywhere
  std::filesystem::permissions(folder.path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  CHECK_THROWS_WITH(check_folder_of(there, "--snapshot"), Contains("Permission denied"));
  std::filesystem::permissions(folder.path, std::filesystem::perms::owner_all);
}
