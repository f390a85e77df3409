/* Prints CAN frames beside the 13 bytes of a CAN-TO-ETH gateway. The lines of `fill` are those of the gateway's document,
 * but for kind and length, which it writes for standard frames of eight bytes alone.
 *
 * cc -o can_to_eth can_to_eth.c && ./can_to_eth > can_to_eth.txt */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static void fill(uint8_t frame[13], bool extended, bool remote, uint32_t can_id, int dlc, const uint8_t data[8]) {
    frame[0] = 0x00;
    if (extended) frame[0] |= 1 << 7; /* bit[7] = 0 standard frame, 1 extended frame */
    if (remote) frame[0] |= 1 << 6;   /* bit[6] = 0 data frame, 1 remote frame */
    frame[0] |= dlc & 0x0F;           /* bit[3:0] = DLC */
    frame[1] = (can_id >> 24) & 0xFF;
    frame[2] = (can_id >> 16) & 0xFF;
    frame[3] = (can_id >> 8) & 0xFF;
    frame[4] = can_id & 0xFF;
    memset(&frame[5], 0, 8);
    if (!remote) memcpy(&frame[5], data, dlc);
}

static void print(bool extended, bool remote, uint32_t can_id, int dlc, const uint8_t data[8]) {
    uint8_t frame[13];
    fill(frame, extended, remote, can_id, dlc, data);
    printf("%s %s %X %d ", extended ? "extended" : "standard", remote ? "remote" : "data", can_id, dlc);
    if (remote || dlc == 0) printf("-");
    for (int i = 0; i < dlc && !remote; i++) printf("%02X", data[i]);
    printf(" ");
    for (int i = 0; i < 13; i++) printf("%02X", frame[i]);
    printf("\n");
}

int main(void) {
    static const uint8_t enable[8] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC};
    static const uint8_t rising[8] = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88};
    static const uint8_t zeros[8] = {0};
    static const uint32_t standard[] = {0x000, 0x001, 0x0FF, 0x100, 0x200, 0x201, 0x400, 0x7A1, 0x7FF};
    static const uint32_t extended[] = {0, 0x7FF, 0x800, 0x12345678, 0x1FFFFFFF};
    for (size_t i = 0; i < sizeof standard / sizeof *standard; i++) {
        print(false, false, standard[i], 8, enable);
        print(false, true, standard[i], i % 9, zeros);
    }
    for (size_t i = 0; i < sizeof extended / sizeof *extended; i++) {
        print(true, false, extended[i], 8, rising);
        print(true, true, extended[i], i % 9, zeros);
    }
    for (int dlc = 0; dlc <= 8; dlc++) {
        print(false, false, 0x7A1, dlc, rising);
        print(true, false, 0x18FF50E5, dlc, rising);
    }
    return 0;
}
