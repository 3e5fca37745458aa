//! Captions to numbers of word pieces.

mod byte_pairs;
mod letters;
mod vocabulary;
mod word_pieces;

pub use byte_pairs::BytePairs;
pub use word_pieces::WordPieces;
