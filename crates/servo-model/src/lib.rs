//! Serial bus servos as a program on the bus meets them. Written from the memory table of the STS3215 and from others' clients.
#![forbid(unsafe_code)]
