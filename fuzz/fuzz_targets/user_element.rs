#![no_main]
libfuzzer_sys::fuzz_target!(|content: &[u8]| supel_fuzz::read_matrix(content, Some(supel::job::Layout::UserElement)));
