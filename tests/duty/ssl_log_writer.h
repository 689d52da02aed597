// Writes SSL logs byte by byte from the published formats, without the code under test and without protobuf.
#pragma once

#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace heatsoak::duty::testing_logs {

/// Time between two pictures of a camera.
inline constexpr double kFrame_s = 1.0 / 75.0;

/// A protobuf message under construction.
class Message {
 public:
  Message& integer(int field, std::uint64_t value) {
    varint(static_cast<std::uint64_t>(field) << 3);
    varint(value);
    return *this;
  }
  Message& real32(int field, double value) { return fixed(field, 5, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4); }
  Message& real64(int field, double value) { return fixed(field, 1, std::bit_cast<std::uint64_t>(value), 8); }
  Message& text(int field, const std::string& value) {
    varint(static_cast<std::uint64_t>(field) << 3 | 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  Message& message(int field, const Message& value) { return text(field, value.bytes_); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) {
      bytes_ += static_cast<char>(value | 128);
    }
    bytes_ += static_cast<char>(value);
  }
  Message& fixed(int field, int kind, std::uint64_t value, int size) {
    varint(static_cast<std::uint64_t>(field) << 3 | static_cast<std::uint64_t>(kind));
    for (int i = 0; i < size; ++i) {
      bytes_ += static_cast<char>(value >> (8 * i));
    }
    return *this;
  }
  std::string bytes_;
};

struct SeenRobot {
  bool is_yellow = true;
  int id = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double confidence = 1.0;
};

/// Start time of the log: capture times are Unix times.
inline constexpr double kEpoch_s = 1.7e9;

inline Message vision(double time_s, int camera, const std::vector<SeenRobot>& robots, const Message* geometry = nullptr) {
  Message frame;
  frame.integer(1, 7).real64(2, kEpoch_s + time_s).real64(3, kEpoch_s + time_s + 0.01).integer(4, static_cast<std::uint64_t>(camera));
  frame.message(5, Message().real32(1, 0.9).integer(2, 80).real32(3, 12.0).real32(4, 34.0).real32(6, 1.0).real32(7, 2.0));  // ball
  for (const SeenRobot& robot : robots) {
    Message one;
    one.real32(1, robot.confidence)
        .integer(2, static_cast<std::uint64_t>(robot.id))
        .real32(3, robot.x_m * 1000.0)
        .real32(4, robot.y_m * 1000.0);
    one.real32(5, robot.yaw_rad).real32(6, 100.0).real32(7, 200.0).real32(8, 140.0);
    frame.message(robot.is_yellow ? 6 : 7, one);
  }
  Message wrapper;
  wrapper.message(1, frame);
  if (geometry != nullptr) {
    wrapper.message(2, *geometry);
  }
  return wrapper;
}

inline Message camera_at(int camera, double x_m, double y_m) {
  return Message()
      .integer(1, static_cast<std::uint64_t>(camera))
      .real32(2, 500.0)
      .real32(13, x_m * 1000.0)
      .real32(14, y_m * 1000.0)
      .real32(15, 4000.0);
}

inline Message tracked(double time_s, const std::string& uuid, const std::string& name, const std::vector<SeenRobot>& robots) {
  Message frame;
  frame.integer(1, 7).real64(2, kEpoch_s + time_s);
  for (const SeenRobot& robot : robots) {
    Message one;
    one.message(1, Message().integer(1, static_cast<std::uint64_t>(robot.id)).integer(2, robot.is_yellow ? 1 : 2));
    one.message(2, Message().real32(1, robot.x_m).real32(2, robot.y_m)).real32(3, robot.yaw_rad);
    one.message(4, Message().real32(1, 0.5).real32(2, 0.5)).real32(5, 0.1).real32(6, robot.confidence);
    frame.message(4, one);
  }
  return Message().text(1, uuid).text(2, name).message(3, frame);
}

inline Message referee(double time_s, int stage, int command) {
  const Message team =
      Message().text(1, "a team").integer(2, 0).integer(3, 0).integer(5, 0).integer(6, 4).integer(7, 300'000'000).integer(8, 0);
  Message all;
  all.integer(1, static_cast<std::uint64_t>((kEpoch_s + time_s) * 1e6)).integer(2, static_cast<std::uint64_t>(stage));
  all.integer(4, static_cast<std::uint64_t>(command)).integer(5, 1).integer(6, 1).message(7, team).message(8, team);
  return all;
}

class LogWriter {
 public:
  explicit LogWriter(std::int32_t version = 1) { number(static_cast<std::uint32_t>(version), 4); }
  /// Adds a message that is received 12 ms after `time_s`.
  LogWriter& add(double time_s, int type, const std::string& message) {
    starts_.push_back(bytes_.size());
    number(static_cast<std::uint64_t>((kEpoch_s + time_s + 0.012) * 1e9), 8);
    number(static_cast<std::uint64_t>(type), 4);
    number(message.size(), 4);
    bytes_ += message;
    return *this;
  }
  LogWriter& add(double time_s, int type, const Message& message) { return add(time_s, type, message.bytes()); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  /// Offsets of the records.
  [[nodiscard]] const std::vector<std::size_t>& starts() const { return starts_; }

 private:
  void number(std::uint64_t value, int size) {
    for (int i = size - 1; i >= 0; --i) {
      bytes_ += static_cast<char>(value >> (8 * i));
    }
  }
  std::string bytes_ = "SSL_LOG_FILE";
  std::vector<std::size_t> starts_;
};

/// Temporary file, deleted by the destructor.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name, const std::string& bytes = {})
      : folder_(std::filesystem::temp_directory_path() / ("heatsoak_import_" + std::to_string(::getpid()))), path_(folder_ / name) {
    std::filesystem::create_directories(folder_);
    write(bytes);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code error;
    std::filesystem::remove(path_, error);
    std::filesystem::remove(folder_, error);
  }
  /// Overwrites in place, because some file systems flush a file at once that is truncated to zero and rewritten.
  void write(const std::string& bytes) const {
    if (!std::filesystem::exists(path_)) {
      std::ofstream(path_, std::ios::binary) << bytes;
    } else {
      std::fstream(path_, std::ios::binary | std::ios::in | std::ios::out) << bytes;
      std::filesystem::resize_file(path_, bytes.size());
    }
  }
  void append(const std::string& bytes) const { std::ofstream(path_, std::ios::binary | std::ios::app) << bytes; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

/// Compresses the bytes as one gzip member.
inline std::string gzip(std::string bytes) {
  z_stream zip{};
  deflateInit2(&zip, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&zip, bytes.size()), '\0');
  zip.next_in = reinterpret_cast<Bytef*>(bytes.data());
  zip.avail_in = static_cast<uInt>(bytes.size());
  zip.next_out = reinterpret_cast<Bytef*>(packed.data());
  zip.avail_out = static_cast<uInt>(packed.size());
  deflate(&zip, Z_FINISH);
  packed.resize(zip.total_out);
  deflateEnd(&zip);
  return packed;
}

}  // namespace heatsoak::duty::testing_logs
