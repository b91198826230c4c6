#![no_main]
libfuzzer_sys::fuzz_target!(|content: &[u8]| supel_fuzz::read_assembly(content));
