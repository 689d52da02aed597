#include "robot_core/port/memory.h"

#include <cstdint>

namespace {

// A word may alias any object that is copied.
using Word [[gnu::may_alias]] = std::uint32_t;

constexpr std::size_t kBlock_words = 8;

bool is_aligned(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer) % sizeof(Word) == 0; }

}  // namespace

extern "C" {

// Without the attribute GCC would turn these loops into calls of the same functions.
[[gnu::optimize("no-tree-loop-distribute-patterns"), gnu::used]] void* memcpy(void* __restrict to, const void* __restrict from,
                                                                              std::size_t size) {
  auto* target = static_cast<unsigned char*>(to);
  const auto* source = static_cast<const unsigned char*>(from);
  if (is_aligned(target) && is_aligned(source)) {
    auto* to_word = reinterpret_cast<Word*>(target);
    const auto* from_word = reinterpret_cast<const Word*>(source);
    for (; size >= kBlock_words * sizeof(Word); size -= kBlock_words * sizeof(Word)) {
#pragma GCC unroll 8
      for (std::size_t i = 0; i < kBlock_words; ++i) {
        to_word[i] = from_word[i];
      }
      to_word += kBlock_words;
      from_word += kBlock_words;
    }
    for (; size >= sizeof(Word); size -= sizeof(Word)) {
      *to_word++ = *from_word++;
    }
    target = reinterpret_cast<unsigned char*>(to_word);
    source = reinterpret_cast<const unsigned char*>(from_word);
  }
  for (; size > 0; --size) {
    *target++ = *source++;
  }
  return to;
}

[[gnu::optimize("no-tree-loop-distribute-patterns"), gnu::used]] void* memset(void* to, int value, std::size_t size) {
  auto* target = static_cast<unsigned char*>(to);
  const auto byte = static_cast<unsigned char>(value);
  if (is_aligned(target)) {
    const Word word = byte * 0x01010101U;
    auto* to_word = reinterpret_cast<Word*>(target);
    for (; size >= kBlock_words * sizeof(Word); size -= kBlock_words * sizeof(Word)) {
#pragma GCC unroll 8
      for (std::size_t i = 0; i < kBlock_words; ++i) {
        to_word[i] = word;
      }
      to_word += kBlock_words;
    }
    for (; size >= sizeof(Word); size -= sizeof(Word)) {
      *to_word++ = word;
    }
    target = reinterpret_cast<unsigned char*>(to_word);
  }
  for (; size > 0; --size) {
    *target++ = byte;
  }
  return to;
}
}
