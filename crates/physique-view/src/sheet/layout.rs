//! Where everything stands on a contact sheet, in pixels.

use super::ContactSheet;
use crate::ViewError;
use crate::chart::{ChartArea, HEIGHT as CHART_HEIGHT};

pub(super) const MARGIN: u32 = 28;
const GAP: u32 = 6;
const BLOCK_GAP: u32 = 14;
/// The line of labels above a block.
const LABELS: u32 = 24;
pub(super) const TITLE_SIZE: f32 = 24.0;
pub(super) const TEXT_SIZE: f32 = 14.0;
pub(super) const TEXT_LINE: u32 = 22;
/// Narrower sheets have no room for their title.
const LEAST_WIDTH: u32 = 420;

/// The sizes and places of a sheet's parts.
pub(super) struct Layout {
    pub(super) width: u32,
    pub(super) height: u32,
    cell: [u32; 2],
    frames: usize,
    views: usize,
    /// Cells side by side.
    columns: usize,
    /// One or two moments: a column for each view instead of each moment.
    pub(super) transposed: bool,
    left: u32,
    top: u32,
    pub(super) chart: ChartArea,
    pub(super) captions_top: u32,
}

impl Layout {
    pub(super) fn new(sheet: &ContactSheet<'_>) -> Result<Self, ViewError> {
        let (frames, views) = (sheet.frames.len(), sheet.views.len());
        let [cell_width, cell_height] = sheet.cell.map(u64::from);
        if cell_width == 0 || cell_height == 0 {
            return Err(ViewError::BadSize {
                width: cell_width,
                height: cell_height,
            });
        }
        let transposed = frames <= 2 && views > frames;
        // Blocks of nearly equal length rather than full ones and a rest.
        let blocks = if transposed {
            1
        } else {
            frames.div_ceil(sheet.most_columns.max(1))
        };
        let columns = if transposed {
            views
        } else {
            frames.div_ceil(blocks)
        };
        let rows = if transposed { frames } else { views };
        let sum = |count: usize, size: u64, gap: u32| {
            (count as u64)
                .saturating_mul(size.saturating_add(gap.into()))
                .saturating_sub(gap.into())
        };
        let cells_width = sum(columns, cell_width, GAP);
        let width = cells_width
            .max(LEAST_WIDTH.into())
            .saturating_add(2 * u64::from(MARGIN));
        let block_height = sum(rows, cell_height, GAP).saturating_add(LABELS.into());
        let head = MARGIN + header_height(sheet);
        let blocks_bottom = u64::from(head).saturating_add(sum(blocks, block_height, BLOCK_GAP));
        let chart_height = if sheet.chart.is_some() {
            CHART_HEIGHT + 2 * BLOCK_GAP
        } else {
            0
        };
        let captions_height = sheet.captions.len() as u64 * u64::from(TEXT_LINE)
            + if sheet.captions.is_empty() {
                0
            } else {
                u64::from(BLOCK_GAP)
            };
        let height = blocks_bottom
            .saturating_add(u64::from(chart_height + MARGIN))
            .saturating_add(captions_height);
        if width.saturating_mul(height) > crate::MAX_PIXELS {
            return Err(ViewError::BadSize { width, height });
        }
        // All below the limit of pixels now, so that the casts hold.
        let (width, blocks_bottom) = (width as u32, blocks_bottom as u32);
        let chart = ChartArea {
            left: MARGIN as f32,
            top: (blocks_bottom + 2 * BLOCK_GAP) as f32,
            width: (width - 2 * MARGIN) as f32,
        };
        Ok(Self {
            width,
            height: height as u32,
            cell: sheet.cell,
            frames,
            views,
            columns,
            transposed,
            left: (width - cells_width as u32) / 2,
            top: head,
            chart,
            captions_top: blocks_bottom + chart_height + BLOCK_GAP,
        })
    }

    /// The top left corner of the picture of a moment from a view.
    pub(super) fn corner(&self, frame: usize, view: usize) -> (i64, i64) {
        let (block, column, row) = if self.transposed {
            (0, view, frame)
        } else {
            (frame / self.columns, frame % self.columns, view)
        };
        let rows = if self.transposed {
            self.frames
        } else {
            self.views
        };
        let step = |size: u32| i64::from(size + GAP);
        let block_height =
            rows as i64 * step(self.cell[1]) - i64::from(GAP) + i64::from(LABELS + BLOCK_GAP);
        (
            i64::from(self.left) + column as i64 * step(self.cell[0]),
            i64::from(self.top + LABELS)
                + block as i64 * block_height
                + row as i64 * step(self.cell[1]),
        )
    }

    /// Whether a cell stands at the head of its column, and at the head of its row.
    pub(super) fn leads(&self, frame: usize, view: usize) -> (bool, bool) {
        if self.transposed {
            (frame == 0, view == 0)
        } else {
            (view == 0, frame.is_multiple_of(self.columns))
        }
    }
}

fn header_height(sheet: &ContactSheet<'_>) -> u32 {
    let title = if sheet.title.is_empty() {
        0
    } else {
        TITLE_SIZE as u32 + 10
    };
    let second = if sheet.subtitle.is_empty() && sheet.legend.is_empty() {
        0
    } else {
        TEXT_LINE + 8
    };
    title + second
}
