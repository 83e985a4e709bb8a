// Serves the page and its WebSockets from the loop of its owner: no thread, no wait. One file knows the library, Boost.Beast.
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
  // Design: the windows of some people, and no flood of connections.
  static constexpr std::size_t kMaxPages = 8, kMaxConnections = 32;

  struct Impl;  // of web_server.cpp
  struct Events {
    std::function<void(int page)> opened, closed;
    std::function<void(int page, std::string_view text)> message;
  };
  // listen_fd: a socket that listens already; it is the server's from here on. files: by path, "/" first of all. Throws
  // std::runtime_error with one sentence when it is none.
  WebServer(int listen_fd, std::map<std::string, PageFile> files, std::string token, bool loopback, Events events);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Handles what has come until something was done or so much time has passed; returns after `at_most` at the latest.
  void run_for(std::chrono::nanoseconds at_most);

  // To one page, or none when it has gone.
  void send(int page, std::shared_ptr<const std::string> text);
  void send_picture(int page, std::shared_ptr<const std::string> picture);
  const SendQueue* queue(int page) const;
  int port() const;
  // Requests of foreign pages and wrong tokens.
  std::int64_t refused() const;

 private:
  std::shared_ptr<Impl> impl_;
};

// A socket that listens on this address. Throws std::runtime_error with one sentence.
int listen_on(const std::string& address, int port);

}  // namespace tactus::live
