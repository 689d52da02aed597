// The program on the target: runs a function on each record of the input file.
#pragma once

#include "replay_files.h"
#include "robot_core/port/instruction_counter.h"
#include "robot_core/port/memory.h"
#include "robot_core/port/semihosting.h"
#include "robot_core/port/stack_gauge.h"

namespace heatsoak::target {

/// Ends the program with exit code 1.
[[noreturn]] inline void give_up(const char* message) {
  robot_core::port::print(message);
  robot_core::port::exit(1);
}

inline int open_or_give_up(const char* name, robot_core::port::OpenMode mode) {
  const int file = robot_core::port::open(name, mode);
  if (file < 0) {
    give_up("a file cannot be opened\n");
  }
  return file;
}

inline std::uint32_t count_of_known_loop() {
  return robot_core::port::count_instructions([] {
    std::uint32_t rounds = 0;
    asm volatile("movw %0, %1\n1:\tsubs %0, #1\n\tbne 1b" : "=l"(rounds) : "i"(kLoopRounds) : "cc");
  });
}

/// Zeroed memory for values, because no constructors of globals run on the target.
template <typename Value, int kCount>
struct Room {
  alignas(Value) unsigned char bytes[sizeof(Value) * kCount];
  Value* values() { return reinterpret_cast<Value*>(bytes); }
};

/// Writes files in blocks, because a call of the host takes longer than a record.
template <typename Value>
class BlockWriter {
 public:
  static constexpr int kBlock = 64;

  BlockWriter(const char* name, Room<Value, kBlock>& block)
      : file_(open_or_give_up(name, robot_core::port::OpenMode::write)), block_(block.values()) {}

  void add(const Value& value) {
    memcpy(&block_[count_++], &value, sizeof(Value));
    if (count_ == kBlock) {
      flush();
    }
  }

  void flush() {
    if (!robot_core::port::write(file_, block_, static_cast<std::uint32_t>(count_) * sizeof(Value))) {
      give_up("a file cannot be written\n");
    }
    count_ = 0;
  }

 private:
  int file_;
  int count_ = 0;
  Value* block_;
};

/// Runs `run(record, result)` on all records, with zeroed results, then `finish(result)`. Instructions are counted for `run` alone. The
/// stack is the larger one of `run` and of the file calls, which are shallow. `memory_bytes`: memory that `run` keeps between two
/// records.
template <typename Record, typename Result>
void replay(void (*run)(const Record&, Result&), void (*finish)(Result&), std::uint32_t memory_bytes) {
  using namespace robot_core::port;
  static Room<Record, 1> record_room;
  static Room<Result, 1> result_room;
  static Room<Result, BlockWriter<Result>::kBlock> result_block;
  static Room<std::uint32_t, BlockWriter<std::uint32_t>::kBlock> count_block;
  Record& record = *record_room.values();
  Result& result = *result_room.values();
  BlockWriter<Result> results(kOutputFile, result_block);
  BlockWriter<std::uint32_t> counts(kInstructionsFile, count_block);
  ReplaySummary summary{.record_size = sizeof(Record),
                        .result_size = sizeof(Result),
                        .memory_bytes = memory_bytes,
                        .known_loop_instructions = count_of_known_loop()};
  const int input = open_or_give_up(kInputFile, OpenMode::read);
  std::uint32_t top = 0;
  fill_stack();
  for (;; ++summary.record_count) {
    const auto size = read(input, &record, sizeof(Record));
    if (size == 0) {
      break;
    }
    if (size != sizeof(Record)) {
      give_up("the input ends within a record\n");
    }
    memset(&result, 0, sizeof(Result));
    counts.add(count_instructions([&] {
      top = stack_pointer();
      run(record, result);
    }));
    finish(result);
    results.add(result);
  }
  summary.most_stack_bytes = stack_bytes_below(top);
  results.flush();
  counts.flush();
  const int file = open_or_give_up(kSummaryFile, OpenMode::write);
  write(file, &summary, sizeof(summary));
}

}  // namespace heatsoak::target
