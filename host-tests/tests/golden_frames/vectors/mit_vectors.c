/*
 * Makes the golden vectors of the motors' MIT protocol. float_to_uint, uint_to_float, encode_mit and the unpacking in
 * print_reply are the vendor document's code (RS00 MIT protocol reference, sections 2, 3 and 5.1); only the ranges have
 * become arguments, so that the same code serves DM4310 (hardware reference, section 8: same packing, other ranges).
 *
 * See README.md for the commands.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct ranges { float p, v, t; };
static const struct ranges DM4310 = {12.5f, 30.0f, 10.0f};
static const struct ranges RS00 = {12.57f, 33.0f, 14.0f};
#define KP_MIN 0.0f
#define KP_MAX 500.0f
#define KD_MIN 0.0f
#define KD_MAX 5.0f

int float_to_uint(float x, float x_min, float x_max, int bits) {
    float span = x_max - x_min;
    if (x > x_max) x = x_max;
    else if (x < x_min) x = x_min;
    return (int)((x - x_min) * ((float)((1 << bits) - 1)) / span);
}

float uint_to_float(int x_int, float x_min, float x_max, int bits) {
    float span = x_max - x_min;
    return ((float)x_int) * span / ((float)((1 << bits) - 1)) + x_min;
}

void encode_mit(const struct ranges *r, uint8_t data[8], float pos, float vel, float kp, float kd, float torque) {
    uint16_t pos_u  = float_to_uint(pos,    -r->p,  r->p,   16);
    uint16_t vel_u  = float_to_uint(vel,    -r->v,  r->v,   12);
    uint16_t kp_u   = float_to_uint(kp,     KP_MIN, KP_MAX, 12);
    uint16_t kd_u   = float_to_uint(kd,     KD_MIN, KD_MAX, 12);
    uint16_t torq_u = float_to_uint(torque, -r->t,  r->t,   12);

    data[0] = pos_u >> 8;
    data[1] = pos_u & 0xFF;
    data[2] = vel_u >> 4;
    data[3] = ((vel_u & 0xF) << 4) | (kp_u >> 8);
    data[4] = kp_u & 0xFF;
    data[5] = kd_u >> 4;
    data[6] = ((kd_u & 0xF) << 4) | (torq_u >> 8);
    data[7] = torq_u & 0xFF;
}

static uint32_t bits_of(float x) {
    uint32_t bits;
    memcpy(&bits, &x, 4);
    return bits;
}

static void print_bytes(const uint8_t data[8]) {
    for (int i = 0; i < 8; i++) printf("%02X", data[i]);
}

/* One line: motor, five floats as their bits, the eight bytes. */
static void print_command(const char *motor, const struct ranges *r, float p, float v, float kp, float kd, float t) {
    uint8_t data[8];
    encode_mit(r, data, p, v, kp, kd, t);
    printf("%s,%08X,%08X,%08X,%08X,%08X,", motor, bits_of(p), bits_of(v), bits_of(kp), bits_of(kd), bits_of(t));
    print_bytes(data);
    printf("\n");
}

/* One line: motor, the eight bytes, angle, speed and torque as their bits. */
static void print_reply(const char *motor, const struct ranges *r, const uint8_t data[8]) {
    uint16_t angle_u  = (data[1] << 8) | data[2];
    uint16_t vel_u    = (data[3] << 4) | (data[4] >> 4);
    uint16_t torq_u   = ((data[4] & 0x0F) << 8) | data[5];
    float angle    = uint_to_float(angle_u, -r->p, r->p, 16);
    float velocity = uint_to_float(vel_u,   -r->v, r->v, 12);
    float torque   = uint_to_float(torq_u,  -r->t, r->t, 12);
    printf("%s,", motor);
    print_bytes(data);
    printf(",%08X,%08X,%08X\n", bits_of(angle), bits_of(velocity), bits_of(torque));
}

/* Linear congruential generator of Numerical Recipes: the same numbers on every machine. */
static uint32_t state = 1;
static uint32_t next(void) { return state = state * 1664525u + 1013904223u; }
static float uniform(float low, float high) { return low + (high - low) * ((float)(next() >> 8) / 16777216.0f); }

/* Both ends of each range, just inside and just outside, zero, and values far beyond. */
static int boundaries(float low, float high, float *out) {
    float step = (high - low) / 4095.0f;
    float values[] = {low, low - step, low + step, low * 2.0f - 1.0f, high, high - step, high + step,
                      high * 2.0f + 1.0f, 0.0f, -0.0f, step / 2.0f, -step / 2.0f, 1e30f, -1e30f};
    memcpy(out, values, sizeof values);
    return (int)(sizeof values / sizeof values[0]);
}

static void commands(const char *motor, const struct ranges *r) {
    float low[5] = {-r->p, -r->v, KP_MIN, KD_MIN, -r->t};
    float high[5] = {r->p, r->v, KP_MAX, KD_MAX, r->t};
    print_command(motor, r, 0, 0, 0, 0, 0);
    print_command(motor, r, 1.0f, 0, 20.0f, 1.0f, 0.5f);
    for (int field = 0; field < 5; field++) {
        float edge[16];
        int count = boundaries(low[field], high[field], edge);
        for (int i = 0; i < count; i++) {
            float x[5] = {0.25f, -0.5f, 12.0f, 0.75f, 1.5f};
            x[field] = edge[i];
            print_command(motor, r, x[0], x[1], x[2], x[3], x[4]);
        }
    }
    for (int i = 0; i < 400; i++) {
        float x[5];
        for (int field = 0; field < 5; field++) {
            float margin = 0.05f * (high[field] - low[field]);
            x[field] = uniform(low[field] - margin, high[field] + margin);
        }
        print_command(motor, r, x[0], x[1], x[2], x[3], x[4]);
    }
}

static void replies(const char *motor, const struct ranges *r) {
    static const uint8_t fixed[4][8] = {
        {1, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00},
        {1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x00},
        {1, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0x00, 0x00},
        {1, 0x80, 0x00, 0x80, 0x08, 0x00, 0x00, 0x00},
    };
    for (int i = 0; i < 4; i++) print_reply(motor, r, fixed[i]);
    for (int i = 0; i < 400; i++) {
        uint8_t data[8] = {1};
        for (int k = 1; k < 6; k++) data[k] = next() >> 24;
        print_reply(motor, r, data);
    }
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "commands") == 0) {
        printf("motor,pos_rad,vel_rps,kp,kd,torque_nm,payload\n");
        commands("dm4310", &DM4310);
        commands("rs00", &RS00);
        return 0;
    }
    if (argc == 2 && strcmp(argv[1], "replies") == 0) {
        printf("motor,payload,pos_rad,vel_rps,torque_nm\n");
        replies("dm4310", &DM4310);
        replies("rs00", &RS00);
        return 0;
    }
    return 1;
}
