// The server of the page with real sockets on the loopback interface, and clients that misuse it.
#include "scripts/live/web_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

using namespace tactus::live;

namespace {

constexpr int kMaxRounds = 2000;  // of 1 ms: far more than a request takes

struct Client {
  int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  explicit Client(int port) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, "127.0.0.1", &at.sin_addr);
    REQUIRE(connect(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0);
    fcntl(fd, F_SETFL, O_NONBLOCK);
  }
  ~Client() { close(fd); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(const std::string& text) { REQUIRE(::send(fd, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size())); }
  // The received text so far.
  std::string receive() {
    char bytes[4096];
    std::string text;
    for (ssize_t n; (n = recv(fd, bytes, sizeof bytes, 0)) > 0;) text.append(bytes, static_cast<std::size_t>(n));
    return text;
  }
};

std::unique_ptr<WebServer> server_of_one_page() {
  return std::make_unique<WebServer>(listen_on("127.0.0.1", 0), std::map<std::string, PageFile>{{"/", {"text/html", "the page"}}}, "0123456789abcdef", true,
                                     WebServer::Events{[](int) {}, [](int) {}, [](int, std::string_view) {}});
}

std::string get(WebServer& server, Client& client) {
  client.send("GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n\r\n");
  std::string text;
  for (int i = 0; i < kMaxRounds && text.find("the page") == std::string::npos; ++i) {
    server.run_for(std::chrono::milliseconds(1));
    text += client.receive();
  }
  return text;
}

}  // namespace

TEST_CASE("Idle connections cannot keep a page out") {
  const auto owner = server_of_one_page();
  WebServer& server = *owner;
  std::vector<std::unique_ptr<Client>> idle;
  for (std::size_t i = 0; i < 3 * WebServer::kMaxConnections; ++i) {
    idle.push_back(std::make_unique<Client>(server.port()));
    if (i % 2 == 0) idle.back()->send("GET / HTTP/1.1\r\nHost: ");  // a request without an end
    server.run_for(std::chrono::milliseconds(1));
  }
  Client page(server.port());
  CHECK(get(server, page).find("200 OK") != std::string::npos);
}

TEST_CASE("A request that names another host is refused and counted") {
  const auto owner = server_of_one_page();
  WebServer& server = *owner;
  Client foreign(server.port());
  foreign.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  std::string text;
  for (int i = 0; i < kMaxRounds && text.empty(); ++i) {
    server.run_for(std::chrono::milliseconds(1));
    text += foreign.receive();
  }
  CHECK(text.find("403 Forbidden") != std::string::npos);
  CHECK(server.refused() == 1);
}
