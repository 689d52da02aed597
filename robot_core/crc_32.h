/* CRC-32 of bytes: IEEE 802.3, reflected, with all bits inverted before and after. Plain C99: the drive core and the exported C header
   share this text. Without a table, because it runs only at start-up and when temperatures are saved. */
#ifndef HEATSOAK_CRC_32_H
#define HEATSOAK_CRC_32_H 0x858b72dfu /* check sum of this text */

#include <stdint.h>

/* CRC-32 of `count` bytes; 0 for none. */
static inline uint32_t heatsoak_crc_32(const uint8_t *bytes, int32_t count) {
  uint32_t crc = 0xffffffffu;
  int32_t i;
  int bit;
  for (i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1u) != 0u ? 0xedb88320u : 0u);
    }
  }
  return ~crc;
}

#elif HEATSOAK_CRC_32_H != 0x858b72dfu
#error "generated headers of different heatsoak versions in one program: generate all of them with the same one"
#endif
