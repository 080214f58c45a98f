mod circles; mod module; mod tokens;
fn main(){ for a in std::env::args().skip(1) { println!("== {a}");
 let c = circles::Crate::read(std::path::Path::new(&a)).unwrap();
 for e in c.edges_of_circles() { println!("  {e}"); } } }
