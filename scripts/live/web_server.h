// Serves the page and its WebSockets from the loop of its owner: without a thread, without waiting. Boost.Beast is used only
// in web_server.cpp.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "scripts/live/origin.h"
#include "scripts/live/send_queue.h"

namespace tactus::live {

struct PageFile {
  std::string type, bytes;
};

class WebServer {
 public:
  // Design: enough windows for a few users, and a limit against floods of connections.
  static constexpr std::size_t kMaxPages = 8, kMaxConnections = 32;

  struct Impl;  // of web_server.cpp
  struct Events {
    std::function<void(int page)> opened, closed;
    std::function<void(int page, std::string_view text)> message;
  };
  // listen_fd: a listening socket; the server takes ownership. files: by path, "/" at least. Throws std::runtime_error with
  // one sentence when listen_fd is not a listening socket.
  WebServer(int listen_fd, std::map<std::string, PageFile> files, std::string token, bool loopback, Events events);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Handles events until at least one was handled or max_wait has passed.
  void run_for(std::chrono::nanoseconds max_wait);

  // Sends a text to one page; no effect when the page is closed.
  void send(int page, std::shared_ptr<const std::string> text);
  void send_picture(int page, std::shared_ptr<const std::string> picture);
  const SendQueue* queue(int page) const;
  int port() const;
  // Number of refused requests: from foreign pages, or with wrong tokens.
  std::int64_t refused() const;

 private:
  std::shared_ptr<Impl> impl_;
};

// Opens a socket that listens on this address. Throws std::runtime_error with one sentence.
int listen_on(const std::string& address, int port);

}  // namespace tactus::live
