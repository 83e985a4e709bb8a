#include "sync/sandbox/sandbox.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <new>

#include "sync/sandbox/reader_process.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus::sync;

namespace {

// The letters that `work` writes to its descriptor in a process of its own.
std::string in_process(const std::function<void(int)>& work) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    work(ends[1]);
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char c = 0;
  while (read(ends[0], &c, 1) == 1) text += c;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  return text;
}

bool opens(const std::string& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (file >= 0) close(file);
  return file >= 0;
}

std::string why_ended(const std::string& program, const std::vector<std::string>& arguments, const ReaderLimits& limits = {}) {
  try {
    read_in_process(program, arguments, limits);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("A confined process reads the files of its folders, and reaches nothing else") {
  const TemporaryFolder folder, other;
  const std::string inside = folder.path / "a", outside = other.path / "b";
  std::ofstream(inside) << "a";
  std::ofstream(outside) << "b";
  const pid_t parent = getpid();
  const std::string done = in_process([&](int out) {
    const Confinement confinement = confine_process({folder.path}, {});
    const auto say = [&](char letter, bool yes) {
      if (yes && write(out, &letter, 1) != 1) _exit(1);
    };
    say('F', confinement.files), say('S', confinement.system_calls), say('C', confinement.capabilities);
    say('r', opens(inside, O_RDONLY));
    say('o', opens(outside, O_RDONLY)), say('p', opens("/etc/passwd", O_RDONLY));
    say('l', opens(folder.path / "../" / other.path.filename() / "b", O_RDONLY));
    say('w', opens(inside, O_WRONLY)), say('t', opens(inside, O_RDONLY | O_TRUNC)), say('n', opens(folder.path / "new", O_RDWR | O_CREAT));
    say('i', socket(AF_INET, SOCK_DGRAM, 0) >= 0), say('u', socket(AF_UNIX, SOCK_STREAM, 0) >= 0);
    say('k', kill(parent, 0) == 0), say('d', unlink(inside.c_str()) == 0), say('m', mkdir((folder.path / "x").c_str(), 0700) == 0);
    say('h', chmod(inside.c_str(), 04755) == 0);
    say('x', mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
    const pid_t child = fork();
    if (child == 0) _exit(0);
    say('f', child > 0);
  });
  INFO(done);
  CHECK(done.find('r') != std::string::npos);
  CHECK(done.find('C') != std::string::npos);
  if (done.find('F') == std::string::npos) WARN("this kernel has no Landlock: a confined process can read other files");
  if (done.find('S') == std::string::npos) WARN("this kernel has no seccomp: a confined process can use any system call");
  if (done.find('F') != std::string::npos) CHECK(done.find_first_of("oplwtndm") == std::string::npos);
  if (done.find('S') != std::string::npos) CHECK(done.find_first_of("wtniukdmhxf") == std::string::npos);
}

TEST_CASE("A confined process keeps no capability, but root may read files of other users below its folders") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "a") << "a";
  std::filesystem::permissions(folder.path / "a", std::filesystem::perms::none);
  const bool read_before = opens(folder.path / "a", O_RDONLY);  // by root
  const std::string done = in_process([&](int out) {
    const Confinement confinement = confine_process({folder.path}, {});
    const char letters[] = {confinement.files ? 'F' : '-', opens(folder.path / "a", O_RDONLY) ? 'r' : '-'};
    if (write(out, letters, 2) != 2) _exit(1);
  });
  REQUIRE(done.size() == 2);
  CHECK((done[1] == 'r') == (read_before && done[0] == 'F'));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("A confined process cannot allocate more than its limit") {
  const std::string done = in_process([](int out) {
    confine_process({}, {.memory_bytes = std::uint64_t{512} << 20});
    const auto say = [&](std::size_t bytes) {
      char* const memory = new (std::nothrow) char[bytes];
      const char letter = memory ? 'y' : 'n';
      if (write(out, &letter, 1) != 1) _exit(1);
      delete[] memory;
    };
    say(std::size_t{16} << 20), say(std::size_t{1} << 30);
  });
  CHECK(done == "yn");
}
#endif

TEST_CASE("A measure that the kernel offers and refuses stops a reader, and one that it lacks is named to the user") {
  const auto with = [](bool files, bool calls, bool capabilities) { return Confinement{files, calls, capabilities}; };
  for (const bool files : {false, true})
    for (const bool calls : {false, true}) {
      const Confinement available = with(files, calls, true);
      CAPTURE(files, calls);
      CHECK(missing_measure(available, available).empty());
      CHECK(missing_measure(with(false, calls, true), available).empty() == !files);
      CHECK(missing_measure(with(files, false, true), available).empty() == !calls);
      CHECK_THAT(missing_measure(with(files, calls, false), available), Catch::Contains("dropping capabilities"));
      const std::string notice = confinement_notice(available);
      CHECK(notice.empty() == (files && calls));
      CHECK((notice.find("Landlock") < notice.find(":")) == !files);
      CHECK((notice.find("seccomp filters") < notice.find(":")) == !calls);
      if (!notice.empty()) CHECK_THAT(notice, Catch::Contains("could") && Catch::Contains("lsm=landlock"));
    }
  CHECK_THAT(missing_measure(with(false, true, true), with(true, true, true)), Catch::Contains("Landlock"));
  CHECK_THAT(missing_measure(with(true, false, true), with(true, true, true)), Catch::Contains("seccomp"));
}

TEST_CASE("A confined process gets every measure that the kernel offers") {
  const TemporaryFolder folder;
  const Confinement available = available_confinement();
  const std::string done = in_process([&](int out) {
    const bool missing = !missing_measure(confine_process({folder.path}, {}), available).empty();
    const char letter = missing ? 'm' : 'c';
    if (write(out, &letter, 1) != 1) _exit(1);
  });
  CHECK(done == "c");
}

TEST_CASE("A reader that ends badly, never, or with too much output is one clause") {
  setenv("TACTUS_BIN", "/bin", 1);
  CHECK_THAT(why_ended("no_such_reader", {}), Catch::Contains("no_such_reader") && Catch::Contains("is missing"));
  CHECK(why_ended("true", {}) == "its reader returned nothing");
  CHECK(why_ended("false", {}) == "its reader failed: the file is damaged or hostile; export it again");
  CHECK(why_ended("head", {"-c", "100", "/dev/zero"}) == "its reader ended too early: the file is damaged or hostile; export it again");
  CHECK(why_ended("cat", {"/dev/zero"}, {.max_bytes = 1 << 20}) == "it has more than 1 MiB of content: simplify it");
  CHECK(why_ended("sleep", {"1000"}, {.timeout = std::chrono::seconds(0)}) == "it takes too long to read: simplify it");
  CHECK_THAT(why_ended("sh", {"-c", "kill -SEGV $$"}), Catch::StartsWith("its reader crashed (Segmentation fault)"));
  unsetenv("TACTUS_BIN");
}

TEST_CASE("A reader's error is one line of printable text") {
  Record record{'E', {'a', '\n', 0x1b, 'b'}};
  CHECK(text_of(record) == "a  b");
  record.content.assign(1000, 'x');
  CHECK(text_of(record).size() == 400);
}

TEST_CASE("An incomplete result of a reader is rejected before memory is allocated for it") {
  Packer packer;
  packer.put_list(std::vector<double>{1, 2, 3});
  packer.put_list(std::string("four"));
  const std::vector<std::uint8_t> whole = packer.take();
  {
    Unpacker from(whole);
    CHECK(from.get_list<std::vector<double>>() == std::vector<double>{1, 2, 3});
    CHECK(from.get_list<std::string>() == "four");
    CHECK(from.at_end());
  }
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Unpacker from{std::span(whole).first(size)};
    CHECK_THROWS_AS((from.get_list<std::vector<double>>(), from.get_list<std::string>()), std::runtime_error);
  }
  std::vector<std::uint8_t> huge(16, 0xff);
  CHECK_THROWS_AS(Unpacker(huge).get_list<std::vector<double>>(), std::runtime_error);
  CHECK_THROWS_AS(Unpacker(huge).get_count(1), std::runtime_error);
}

TEST_CASE("A confined process starts a thread only where it is allowed, and the thread is confined too") {
  const TemporaryFolder folder;
  const std::string inside = folder.path / "a";
  std::ofstream(inside) << "a";
  for (const bool allowed : {false, true}) {
    const std::string done = in_process([&](int out) {
      confine_process({folder.path}, {.threads = allowed});
      pthread_t thread;
      struct Work {
        const std::string& inside;
        int out;
      } work{inside, out};
      const auto run = [](void* given) -> void* {
        const Work& w = *static_cast<Work*>(given);
        std::string found = "t";
        if (opens(w.inside, O_RDONLY)) found += "r";
        if (opens("/etc/passwd", O_RDONLY)) found += "p";
        if (opens(w.inside, O_WRONLY)) found += "w";
        if (socket(AF_INET, SOCK_DGRAM, 0) >= 0) found += "i";
        if (write(w.out, found.data(), found.size()) < 0) _exit(1);
        return nullptr;
      };
      if (pthread_create(&thread, nullptr, run, &work) == 0) pthread_join(thread, nullptr);
      if (fork() >= 0 && write(out, "f", 1) < 0) _exit(1);  // a process is never allowed
    });
    const Confinement available = available_confinement();
    if (available.files && available.system_calls) CHECK(done == (allowed ? "tr" : ""));
  }
}
