#include "scripts/live/web_server.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <algorithm>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <utility>

#include "scripts/live/browser_message.h"

namespace tactus::live {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using Code = boost::system::error_code;

namespace {

constexpr std::size_t kMaxHeaderBytes = 8192;
constexpr std::chrono::seconds kRequestTimeout{10};  // design
// Design: a page that is silent for this time, also to pings, is closed. Until then a frozen page takes the memory of a full
// queue.
constexpr std::chrono::seconds kIdleTimeout{60};

class Page;
class Connection;

}  // namespace

struct WebServer::Impl : std::enable_shared_from_this<WebServer::Impl> {
  boost::asio::io_context io{1};
  tcp::acceptor acceptor{io};
  std::map<std::string, PageFile> files;
  Access access;
  Events events;
  std::map<int, std::shared_ptr<Page>> pages;
  std::deque<std::weak_ptr<Connection>> requests;  // in the order of their arrival
  std::size_t connections = 0;
  int next_page = 1;
  std::int64_t refused = 0;

  void accept();
  // Closes the oldest connection that has not sent its request, otherwise the oldest that does not take its answer. Returns false without one.
  bool close_oldest();
};

namespace {

// One WebSocket. Single-threaded.
class Page : public std::enable_shared_from_this<Page> {
 public:
  Page(beast::tcp_stream stream, std::shared_ptr<WebServer::Impl> server) : socket_(std::move(stream)), server_(server) {}

  void open(http::request<http::empty_body> request) {
    request_ = std::move(request);
    socket_.read_message_max(kMaxBrowserBytes);
    socket_.set_option(websocket::stream_base::timeout{kRequestTimeout, kIdleTimeout, true});
    socket_.async_accept(request_, [self = shared_from_this()](Code e) { self->opened(e); });
  }
  void pump() {
    if (writing_ || !open_) return;
    auto next = queue.pop();
    if (!next) return;
    sending_ = std::move(*next);
    writing_ = true;
    socket_.binary(sending_.binary);
    socket_.async_write(boost::asio::buffer(*sending_.bytes), [self = shared_from_this()](Code e, std::size_t) {
      self->writing_ = false;
      if (e) return self->closed();
      self->pump();
    });
  }

  SendQueue queue;

 private:
  void opened(Code e) {
    const auto server = server_.lock();
    if (e || !server || server->pages.size() >= WebServer::kMaxPages) return;
    open_ = true;
    number_ = server->next_page++;
    server->pages[number_] = shared_from_this();
    server->events.opened(number_);
    read();
  }
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Code e, std::size_t) {
      if (e) return self->closed();
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (const auto server = self->server_.lock()) server->events.message(self->number_, text);
      self->read();
    });
  }
  void closed() {
    if (!std::exchange(open_, false)) return;
    if (const auto server = server_.lock()) {
      server->events.closed(number_);
      server->pages.erase(number_);
    }
  }

  websocket::stream<beast::tcp_stream> socket_;
  std::weak_ptr<WebServer::Impl> server_;
  http::request<http::empty_body> request_;
  beast::flat_buffer buffer_{kMaxBrowserBytes * 2};
  Outgoing sending_;
  bool open_ = false, writing_ = false;
  int number_ = 0;
};

// One request: it becomes a WebSocket, is answered with a file, or is refused.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, std::shared_ptr<WebServer::Impl> server) : stream_(std::move(socket)), server_(server) {
    ++server->connections;
  }
  ~Connection() {
    if (const auto server = server_.lock()) --server->connections;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_waiting() const { return waiting_; }
  void close() {
    waiting_ = false;
    stream_.close();
  }
  void read() {
    parser_.header_limit(kMaxHeaderBytes);
    parser_.body_limit(0);
    stream_.expires_after(kRequestTimeout);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](Code e, std::size_t) {
      if (std::exchange(self->waiting_, false) && !e) self->answer();
    });
  }

 private:
  void answer() {
    const auto server = server_.lock();
    if (!server) return;
    const auto& request = parser_.get();
    const std::string host(request[http::field::host]), target(request.target());
    if (!host_allowed(host, server->access))
      return refuse(http::status::forbidden, "This server answers only to the address that it printed.\n");
    if (websocket::is_upgrade(request)) {
      const std::string origin(request[http::field::origin]);
      if (!origin_allowed(origin, host) || !token_matches(target, server->access))
        return refuse(http::status::forbidden, "Open the address that was printed, with its token.\n");
      stream_.expires_never();
      std::make_shared<Page>(std::move(stream_), server)->open(parser_.release());
      return;
    }
    const auto file = server->files.find(target.substr(0, target.find('?')));
    if (request.method() != http::verb::get || file == server->files.end())
      return respond(http::status::not_found, "text/plain", "There is no such page.\n");
    respond(http::status::ok, file->second.type, file->second.bytes);
  }
  void refuse(http::status status, const char* why) {
    if (const auto server = server_.lock()) ++server->refused;
    respond(status, "text/plain", why);
  }
  void respond(http::status status, const std::string& type, std::string body) {
    response_.result(status);
    response_.version(11);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Content-Security-Policy", "default-src 'self'; img-src 'self' blob:; style-src 'self' 'unsafe-inline'");
    response_.keep_alive(false);
    response_.body() = std::move(body);
    response_.prepare_payload();
    stream_.expires_after(kRequestTimeout);
    http::async_write(stream_, response_, [self = shared_from_this()](Code, std::size_t) {
      Code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  std::weak_ptr<WebServer::Impl> server_;
  beast::flat_buffer buffer_{2 * kMaxHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
  bool waiting_ = true;  // for the request
};

}  // namespace

void WebServer::Impl::accept() {
  acceptor.async_accept([self = shared_from_this()](Code e, tcp::socket socket) {
    if (!self->acceptor.is_open()) return;
    // A browser sends its request at once and takes the answer, so that idle connections give way to new ones.
    if (!e && (self->connections < kMaxConnections || self->close_oldest())) {
      Code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      const auto connection = std::make_shared<Connection>(std::move(socket), self);
      std::erase_if(self->requests, [](const std::weak_ptr<Connection>& w) { return w.expired(); });
      self->requests.push_back(connection);
      connection->read();
    }
    self->accept();
  });
}

bool WebServer::Impl::close_oldest() {
  if (requests.empty()) return false;
  auto oldest = std::find_if(requests.begin(), requests.end(), [](const std::weak_ptr<Connection>& w) {
    const auto connection = w.lock();
    return connection && connection->is_waiting();
  });
  if (oldest == requests.end()) oldest = requests.begin();
  if (const auto connection = oldest->lock()) connection->close();
  requests.erase(oldest);
  return true;
}

WebServer::WebServer(int listen_fd, std::map<std::string, PageFile> files, std::string token, bool loopback, Events events)
    : impl_(std::make_shared<Impl>()) {
  Code e;
  impl_->acceptor.assign(tcp::v4(), listen_fd, e);
  int listens = 0;
  socklen_t size = sizeof listens;
  if (e || getsockopt(listen_fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0)
    throw std::runtime_error("descriptor " + std::to_string(listen_fd) +
                             " is not a listening IPv4 socket; use scripts/run --live, which opens it");
  impl_->files = std::move(files);
  impl_->access = {impl_->acceptor.local_endpoint().port(), loopback, std::move(token)};
  impl_->events = std::move(events);
  impl_->accept();
}

WebServer::~WebServer() {
  impl_->events = {[](int) {}, [](int) {}, [](int, std::string_view) {}};
  Code ignored;
  impl_->acceptor.close(ignored);
  impl_->pages.clear();
  impl_->io.poll();  // the handler of the closed acceptor owns impl_
}

void WebServer::run_for(std::chrono::nanoseconds max_wait) { impl_->io.run_for(max_wait); }

void WebServer::send(int page, std::shared_ptr<const std::string> text) {
  const auto found = impl_->pages.find(page);
  if (found == impl_->pages.end()) return;
  found->second->queue.push(std::move(text));
  found->second->pump();
}

void WebServer::send_picture(int page, std::shared_ptr<const std::string> picture) {
  const auto found = impl_->pages.find(page);
  if (found == impl_->pages.end()) return;
  found->second->queue.put_picture(std::move(picture));
  found->second->pump();
}

const SendQueue* WebServer::queue(int page) const {
  const auto found = impl_->pages.find(page);
  return found == impl_->pages.end() ? nullptr : &found->second->queue;
}

int WebServer::port() const { return impl_->access.port; }
std::int64_t WebServer::refused() const { return impl_->refused; }

int listen_on(const std::string& address, int port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    throw std::runtime_error("--bind: \"" + address + "\" is not an IPv4 address; write for example 127.0.0.1");
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 || listen(fd, 16) != 0) {
    const std::string why = std::strerror(errno);
    if (fd >= 0) close(fd);
    throw std::runtime_error("cannot listen on " + address + ":" + std::to_string(port) + " (" + why +
                             "); choose another --http-port");
  }
  return fd;
}

}  // namespace tactus::live
