//! Reads the messages of an MCAP file, also from compressed chunks.

use mcap::read::{ChannelAccumulator, ChunkReader, LinearReader};
use mcap::records::{ChunkHeader, Record};
use mcap::{Channel, McapError, McapResult};
use std::borrow::Cow;
use std::io::Read;

/// Largest number of bytes of a decompressed chunk. Recorders begin a new chunk after a few megabytes. The limit refuses files
/// whose stated size exceeds the memory.
const MAX_CHUNK_BYTES: u64 = 256 << 20;

/// Calls `visit` with the channel, the log time in nanoseconds and the content of each message, in the order of the
/// file.
///
/// # Errors
/// Files that are not MCAP, end too early, or are compressed by an unknown method.
pub(super) fn each_message(bytes: &[u8], mut visit: impl FnMut(&Channel, u64, &[u8])) -> McapResult<()> {
    let mut channels = ChannelAccumulator::default();
    let mut take = |record: Record, channels: &mut ChannelAccumulator<'static>| -> McapResult<()> {
        match record {
            Record::Schema { header, data } => channels.add_schema(header, Cow::Owned(data.into_owned())),
            Record::Channel(channel) => channels.add_channel(channel),
            Record::Message { header, data } => {
                let unknown = || McapError::UnknownChannel(header.sequence, header.channel_id);
                let channel = channels.get(header.channel_id).ok_or_else(unknown)?;
                visit(&channel, header.log_time, &data);
                Ok(())
            }
            _ => Ok(()),
        }
    };
    let mut is_summary = false;
    for record in LinearReader::new(bytes)? {
        match record? {
            // The summary repeats schemas and channels. Reading it shows whether the file ends early.
            Record::DataEnd(_) => is_summary = true,
            _ if is_summary => {}
            Record::Chunk { header, data } => {
                let (header, data) = decompressed(header, &data)?;
                for record in ChunkReader::new(header, &data)? {
                    take(record?, &mut channels)?;
                }
            }
            record => take(record, &mut channels)?,
        }
    }
    Ok(())
}

/// Returns the decompressed records of a chunk, and a matching header.
fn decompressed(header: ChunkHeader, data: &[u8]) -> McapResult<(ChunkHeader, Cow<'_, [u8]>)> {
    let wrong = |why: String| McapError::DecompressionError(why);
    let size = header.uncompressed_size;
    if header.compression.is_empty() {
        return Ok((header, Cow::Borrowed(data)));
    }
    if size > MAX_CHUNK_BYTES {
        return Err(wrong(format!("a chunk of {size} bytes is larger than {} MiB", MAX_CHUNK_BYTES >> 20)));
    }
    let mut content = Vec::new();
    match header.compression.as_str() {
        "zstd" => {
            content.reserve_exact(size as usize);
            let mut decoder = ruzstd::decoding::FrameDecoder::new();
            decoder.decode_all_to_vec(data, &mut content).map_err(|error| wrong(error.to_string()))?;
        }
        "lz4" => {
            let mut decoder = lz4_flex::frame::FrameDecoder::new(data);
            // The decompressor stops at the end of each frame, and a chunk may have several.
            while (content.len() as u64) < size {
                let rest = size - content.len() as u64;
                if decoder.by_ref().take(rest).read_to_end(&mut content)? == 0 {
                    break;
                }
            }
        }
        other => return Err(McapError::UnsupportedCompression(other.to_owned())),
    }
    if content.len() as u64 != size {
        return Err(wrong(format!("a chunk has {} bytes instead of {size}", content.len())));
    }
    Ok((ChunkHeader { compression: String::new(), compressed_size: size, ..header }, Cow::Owned(content)))
}
