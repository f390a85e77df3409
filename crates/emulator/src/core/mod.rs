//! Cortex-M4F: instruction execution through unicorn-engine; exceptions, NVIC, SCB, SysTick and DWT here.
