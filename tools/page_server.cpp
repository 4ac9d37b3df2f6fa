#include "tools/page_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "tools/io/file_bytes.h"

namespace reeb::tools {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFiles = "/files/";
constexpr size_t kMaxRequest = 1 << 14;  // bytes

/// A name as part of an address.
std::string encoded(const std::string& name) {
  constexpr char kHex[] = "0123456789ABCDEF";
  constexpr std::string_view kPlain = "-_.";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

const char* media_type(const fs::path& path) {
  constexpr std::array<std::array<const char*, 2>, 6> kTypes = {{{".html", "text/html"},
                                                                 {".js", "text/javascript"},
                                                                 {".css", "text/css"},
                                                                 {".json", "application/json"},
                                                                 {".wasm", "application/wasm"},
                                                                 {".reeb", "model/vnd.reeb"}}};
  for (const auto& [extension, type] : kTypes) {
    if (path.extension() == extension) return type;
  }
  return "application/octet-stream";
}

/// A request line and the host that it is for.
struct Request {
  std::string method, path, host;
};

Request parse(const std::string& text) {
  Request out;
  const size_t line = text.find("\r\n");
  const size_t first = text.find(' ');
  const size_t last = text.find(' ', first + 1);
  if (last == std::string::npos || last > line) return out;
  out.method = text.substr(0, first);
  out.path = text.substr(first + 1, last - first - 1);
  out.path.resize(std::min(out.path.size(), out.path.find('?')));
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::string_view kHost = "\r\nhost:";
  if (const size_t at = lower.find(kHost); at != std::string::npos) {
    const size_t begin = text.find_first_not_of(' ', at + kHost.size());
    out.host = text.substr(begin, text.find("\r\n", begin) - begin);
  }
  return out;
}

/// A connection that is answered once.
class Connection {
 public:
  explicit Connection(int socket) : socket_(socket) {
    constexpr timeval kPatience = {.tv_sec = 5, .tv_usec = 0};  // others wait meanwhile
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Request read() const {
    std::string text;
    while (text.find("\r\n\r\n") == std::string::npos) {
      char part[1024];
      const ssize_t count = recv(socket_, part, sizeof part, 0);
      if (count <= 0 || text.size() > kMaxRequest) return {};
      text.append(part, static_cast<size_t>(count));
    }
    return parse(text);
  }

  void answer(const char* status, const char* type, std::string_view body, bool with_body) const {
    send_all("HTTP/1.1 " + std::string(status) + "\r\nContent-Type: " + type +
             "\r\nContent-Length: " + std::to_string(body.size()) +
             "\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n");
    if (with_body) send_all(body);
  }

 private:
  void send_all(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return;
      bytes.remove_prefix(static_cast<size_t>(count));
    }
  }

  int socket_;
};

class PageServer {
 public:
  explicit PageServer(const PageOptions& options) : options_(options) {}
  ~PageServer() {
    if (socket_ >= 0) close(socket_);
  }
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  Status open() {
    socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(options_.port));
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (socket_ < 0 || bind(socket_, any, sizeof address) != 0 || listen(socket_, 16) != 0)
      return Status::io("port " + std::to_string(options_.port) +
                        " of this machine cannot be used; leave --port out");
    socklen_t size = sizeof address;
    getsockname(socket_, any, &size);
    port_ = ":" + std::to_string(ntohs(address.sin_port));
    return {};
  }

  std::string address() const { return "http://127.0.0.1" + port_ + "/"; }

  [[noreturn]] void serve() const {
    for (;;) {
      const int socket = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
      if (socket >= 0) answer(Connection(socket));
    }
  }

 private:
  void answer(const Connection& connection) const {
    const Request request = connection.read();
    const bool head = request.method == "HEAD";
    if (request.host != "127.0.0.1" + port_ && request.host != "localhost" + port_)
      return connection.answer("403 Forbidden", "text/plain", "another host", !head);
    if (!head && request.method != "GET")
      return connection.answer("405 Method Not Allowed", "text/plain", "GET alone", true);
    const std::string name = file_of(request.path);
    FileBytes file;
    if (name.empty() || !FileBytes::read(name, file).ok())
      return connection.answer("404 Not Found", "text/plain", "nothing here", !head);
    connection.answer("200 OK", media_type(name), file.view(), !head);
  }

  /// The file that a path stands for: one of those to show, or of the page; empty where there is
  /// none.
  std::string file_of(const std::string& path) const {
    for (size_t i = 0; i < options_.files.size(); ++i) {
      if (path.rfind(std::string(kFiles) + std::to_string(i) + "/", 0) == 0)
        return options_.files[i];
    }
    if (path.empty() || path[0] != '/' || path.find("..") != std::string::npos) return {};
    const fs::path inside = path == "/" ? "index.html" : fs::path(path).relative_path();
    const fs::path file = fs::path(options_.page) / inside;
    std::error_code error;
    return fs::is_regular_file(file, error) ? file.string() : std::string();
  }

  const PageOptions& options_;
  int socket_ = -1;
  std::string port_;
};

/// What the page is asked to show. The name is the last part, for people.
std::string query(const PageOptions& o) {
  const auto place = [&](size_t i) {
    const std::string name = fs::path(o.files[i]).filename().string();
    return encoded(std::string(kFiles.substr(1)) + std::to_string(i) + "/" + encoded(name));
  };
  return "?file=" + place(0) + (o.files.size() > 1 ? "&with=" + place(1) : "");
}

}  // namespace

std::string installed_page() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path page = program.parent_path().parent_path() / "share/reeb/player";
  return fs::exists(page / "index.html", error) ? page.string() : std::string();
}

Status serve_page(const PageOptions& o, const std::function<void(const std::string&)>& ready) {
  std::error_code error;
  if (!fs::exists(fs::path(o.page) / "index.html", error))
    return Status::io(o.page + ": no player here; bindings/web/player/build.sh builds one");
  for (const std::string& name : o.files) {
    FileBytes file;
    if (Status s = FileBytes::read(name, file); !s.ok()) return s;
  }
  PageServer server(o);
  if (Status s = server.open(); !s.ok()) return s;
  ready(server.address() + query(o));
  server.serve();
}

}  // namespace reeb::tools
