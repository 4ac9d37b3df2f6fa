// Result of an operation that can fail on bad data: a stable code and a sentence for people.
#pragma once

#include <string>
#include <utility>

namespace reeb {

enum class StatusCode {
  kOk = 0,
  kInvalidArgument,  ///< the caller broke a pre-condition
  kCorrupt,          ///< the stream breaks the specification
  kTruncated,        ///< the stream ends early
  kUnsupported,      ///< a newer version, or an unknown critical chunk
  kLimitExceeded,    ///< the stream asks for more than the caller's limits allow
  kIo,               ///< a file or callback failed
  kCancelled,        ///< stopped on request
  kOutOfMemory,      ///< the system gave no memory
  kNeedMoreData,     ///< the bytes pushed so far do not reach what was asked for
};

/// Returned by value, never thrown. `message` is empty when ok.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }

  static Status corrupt(std::string what) { return {StatusCode::kCorrupt, std::move(what)}; }
  static Status truncated(std::string what) { return {StatusCode::kTruncated, std::move(what)}; }
  static Status invalid(std::string what) {
    return {StatusCode::kInvalidArgument, std::move(what)};
  }
  static Status limit(std::string what) { return {StatusCode::kLimitExceeded, std::move(what)}; }
  static Status cancelled() { return {StatusCode::kCancelled, "cancelled"}; }
  /// Short enough to need no memory itself.
  static Status out_of_memory() { return {StatusCode::kOutOfMemory, "out of memory"}; }
  static Status io(std::string what) { return {StatusCode::kIo, std::move(what)}; }

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

}  // namespace reeb
