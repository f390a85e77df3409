"""The manufacturer's SDK on a port with six servos: sdk.py PORT. Ids 1 to 6, shafts at 2048, return delay as shipped."""

import sys

from scservo_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupSyncRead,
    GroupSyncWrite,
    PacketHandler,
    PortHandler,
)

IDS = range(1, 7)
port = PortHandler(sys.argv[1])
assert port.setBaudRate(1_000_000)
servos = PacketHandler(0)


def check(result):
    *value, comm, error = result
    assert comm == COMM_SUCCESS, servos.getTxRxResult(comm)
    assert error == 0, servos.getRxPacketError(error)
    return value[0] if value else None


# One servo after the other.
for i in IDS:
    assert check(servos.ping(port, i)) == 777
    assert check(servos.read2ByteTxRx(port, i, 56)) == 2048
    check(servos.write1ByteTxRx(port, i, 40, 1))
    assert check(servos.read1ByteTxRx(port, i, 40)) == 1
assert servos.ping(port, 9)[1] == COMM_RX_TIMEOUT

# All at once: goals out, goals back.
writer = GroupSyncWrite(port, servos, 42, 2)
for i in IDS:
    goal = 2048 + 10 * i
    assert writer.addParam(i, [goal & 0xFF, goal >> 8])
assert writer.txPacket() == COMM_SUCCESS
reader = GroupSyncRead(port, servos, 42, 2)
for i in IDS:
    assert reader.addParam(i)
assert reader.txRxPacket() == COMM_SUCCESS
assert [reader.getData(i, 42, 2) for i in IDS] == [2048 + 10 * i for i in IDS]

# A registered write waits for ACTION.
check(servos.regWriteTxRx(port, 1, 42, 2, [0x00, 0x07]))
assert check(servos.read2ByteTxRx(port, 1, 42)) == 2058
assert check(servos.read1ByteTxRx(port, 1, 64)) == 1
assert servos.action(port, 0xFE) == COMM_SUCCESS
assert check(servos.read2ByteTxRx(port, 1, 42)) == 0x700

# At another baud rate the servos hear noise, until one is told to follow.
assert port.setBaudRate(500_000)
assert servos.ping(port, 1)[1] != COMM_SUCCESS
assert port.setBaudRate(1_000_000)
check(servos.write1ByteTxRx(port, 1, 6, 1))
assert servos.ping(port, 1)[1] != COMM_SUCCESS
assert port.setBaudRate(500_000)
assert check(servos.ping(port, 1)) == 777
check(servos.write1ByteTxRx(port, 1, 6, 0))
port.closePort()
print("done")
