//! What a corner case says of itself, read without its log.

use std::path::Path;

use kernel::SceneSnapshot;
use mcap::records::{Record, op};

use crate::layout::{CHANNELS, Channel, OLDEST_VERSION, version_of};
use crate::records::{Raw, Walk, number};
use crate::scan::{end_of_data, is_finished, is_of_export, starts_as_mcap, unfold};
use crate::{Annotation, CaseInfo, Error, FORMAT_VERSION, Manifest, RunSummary, wire};

/// What a corner case says of itself: where it came from, what was said about it, how its run went, and the scene of the
/// takeover.
///
/// Of the file, the checksums over all of it are checked, and what is read here; its log is not unfolded, and seals are not
/// compared ([`Recording::open`](crate::Recording::open) does both). That is some ten times as fast.
#[derive(Clone, Debug)]
pub struct CaseHeader {
    /// What the run started from; of a foreign map that is not in the manifest, the text is missing.
    pub manifest: Manifest,
    /// Where it was cut from.
    pub info: CaseInfo,
    /// What was said about the intervention.
    pub annotation: Option<Annotation>,
    /// How the run went.
    pub summary: Option<RunSummary>,
    /// The scene of the last tick of its window.
    pub scene: Option<SceneSnapshot>,
    /// blake3 of the file.
    pub digest: [u8; 32],
}

impl CaseHeader {
    /// Reads a case's file; a recording that is no case is refused.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let read = || Self::from_bytes(&intake::read(path, intake::most::RECORDING)?);
        read().map_err(|e: Error| e.within(path))
    }

    /// As [`CaseHeader::open`], from memory.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        starts_as_mcap(bytes)?;
        if !is_finished(bytes) {
            return Err(Error::damaged("the end of the file", "it was cut off; a corner case is written as a whole"));
        }
        let mut found = Found::default();
        for chunk in chunks(&bytes[..end_of_data(bytes)?])? {
            found.take(&chunk)?;
        }
        let missing = || Error::damaged("the data", "it holds no manifest");
        let manifest = found.manifest.ok_or_else(missing)?;
        let info = manifest.case.clone();
        let info = info.ok_or_else(|| Error::Unsuited("a recording, not a corner case".into()))?;
        let (annotation, summary) = found.end;
        let digest = *blake3::hash(bytes).as_bytes();
        Ok(Self { manifest, info, annotation, summary, scene: found.scene, digest })
    }
}

/// The chunks that hold what is looked for, as the message indexes behind them say.
fn chunks(data: &[u8]) -> Result<Vec<Raw<'_>>, Error> {
    let (mut wanted, mut last) = (Vec::new(), None);
    let mut walk = Walk::new(data, true);
    while let Some(record) = walk.next()? {
        match record.op {
            op::CHUNK => last = Some(record),
            op::MESSAGE_INDEX if is_wanted(number::<2>(record.body)) => wanted.extend(last.take()),
            op::METADATA if is_of_export(&record) => return Err(Error::Export),
            _ => {}
        }
    }
    Ok(wanted)
}

fn is_wanted(channel: u64) -> bool {
    [Channel::Manifest, Channel::Scenes, Channel::End].iter().any(|wanted| *wanted as u64 == channel)
}

/// What has been read so far.
#[derive(Default)]
struct Found {
    /// Version of the layout.
    format: Option<u16>,
    manifest: Option<Manifest>,
    scene: Option<SceneSnapshot>,
    end: (Option<Annotation>, Option<RunSummary>),
}

impl Found {
    fn take(&mut self, chunk: &Raw<'_>) -> Result<(), Error> {
        let (header, packed) = match mcap::parse_record(chunk.op, chunk.body) {
            Ok(Record::Chunk { header, data }) if header.compression == "zstd" => (header, data),
            _ => return Err(chunk.damaged("expected a chunk")),
        };
        let records = unfold(&header, &packed).map_err(|reason| chunk.damaged(reason))?;
        let mut walk = Walk { bytes: &records, at: 0, whole: true };
        while let Some(part) = walk.next().map_err(|e| chunk.damaged(e))? {
            self.part(&part).map_err(|reason| chunk.damaged(reason))?;
        }
        Ok(())
    }

    fn part(&mut self, part: &Raw<'_>) -> Result<(), String> {
        match mcap::parse_record(part.op, part.body).map_err(|e| e.to_string())? {
            Record::Schema { header, .. } => {
                let layout = CHANNELS.iter().find(|layout| layout.channel as u16 == header.id);
                let version = layout.and_then(|layout| version_of(&header.name, layout));
                let version = version.filter(|version| (OLDEST_VERSION..=FORMAT_VERSION).contains(version));
                self.format = Some(version.ok_or_else(|| format!("unknown layout {:?}", header.name))?);
                Ok(())
            }
            Record::Message { header, data } => self.message(header.channel_id, &data),
            _ => Ok(()),
        }
    }

    fn message(&mut self, channel: u16, payload: &[u8]) -> Result<(), String> {
        let format = self.format.ok_or("expected its schema before a message")?;
        match Channel::from_id(channel) {
            Some(Channel::Manifest) => self.manifest = Some(wire::manifest(payload, format)?),
            Some(Channel::Scenes) => self.scene = wire::last_scene(payload, format)?,
            Some(Channel::End) => self.end = wire::end(payload)?,
            _ => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::sample;
    use crate::{Case, Recording};

    fn case() -> Vec<u8> {
        let mut log = sample(200);
        log.manifest.case = Some(CaseInfo { source: [7; 32], from: 20, to: 101 });
        log.encode().unwrap()
    }

    #[test]
    fn a_header_says_what_the_whole_case_says() {
        let bytes = case();
        let (header, case) =
            (CaseHeader::from_bytes(&bytes).unwrap(), Case::try_from(Recording::from_bytes(&bytes).unwrap()));
        let case = case.unwrap();
        let log = case.log();
        assert_eq!((&header.info, &header.annotation, &header.summary), (case.info(), &log.annotation, &log.summary));
        assert_eq!(header.scene, log.scenes.last().cloned());
        assert_eq!(header.digest, *blake3::hash(&bytes).as_bytes());
        assert_eq!(header.manifest.scenario, log.manifest.scenario);
        assert_eq!(header.manifest.provenance, log.manifest.provenance);
    }

    #[test]
    fn recordings_and_damaged_files_are_refused() {
        let recording = sample(61).encode().unwrap();
        assert!(matches!(CaseHeader::from_bytes(&recording), Err(Error::Unsuited(_))));
        let bytes = case();
        for cut in 0..bytes.len() {
            assert!(CaseHeader::from_bytes(&bytes[..cut]).is_err(), "cut at {cut}");
        }
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 0x10;
            assert!(CaseHeader::from_bytes(&changed).is_err(), "byte {at} of {}", bytes.len());
        }
    }
}
