//! The transmitting half of a UART: one DMA transfer for each frame.

use embassy_stm32::dma::{Channel, Request, TransferOptions};
use embassy_stm32::pac::usart::Usart;

/// Sends frames of up to `N` bytes.
pub struct UartTransmitter<const N: usize> {
    uart: Usart,
    dma: Channel<'static>,
    request: Request,
    /// In SRAM: DMA cannot reach the stack, which lies in CCM.
    buffer: &'static mut [u8; N],
}

impl<const N: usize> UartTransmitter<N> {
    /// Starts the transmitter of a UART that is set up. `request` must route its transmit requests to `dma`.
    pub fn start(
        uart: Usart,
        dma: Channel<'static>,
        request: Request,
        buffer: &'static mut [u8; N],
    ) -> Self {
        uart.cr1().modify(|w| w.set_te(true));
        Self {
            uart,
            dma,
            request,
            buffer,
        }
    }

    /// Sends a frame. Returns when the UART has taken the last byte, while that one is still on the line.
    pub async fn send<const LEN: usize>(&mut self, frame: &[u8; LEN]) {
        const { assert!(0 < LEN && LEN <= N, "the frame fits into the buffer") };
        let Some(buffer) = self.buffer.first_chunk_mut() else {
            return;
        };
        *buffer = *frame;
        let data_register = self.uart.dr().as_ptr().cast::<u8>();
        // SAFETY: `request` routes this UART's transmit requests to `dma` (board.rs), the data register stays valid,
        // and `buffer` is static memory in SRAM that stays borrowed until the transfer has ended.
        let transfer = unsafe {
            self.dma.write(
                self.request,
                buffer,
                data_register,
                TransferOptions::default(),
            )
        };
        // The request stays high while there is nothing to send, so it is let through only while the stream serves it.
        self.uart.cr3().modify(|w| w.set_dmat(true));
        transfer.await;
        self.uart.cr3().modify(|w| w.set_dmat(false));
    }
}
